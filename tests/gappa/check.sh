#!/usr/bin/env bash
# The errors of src/ulps that Gappa proves, proved, in f64 and f32; and a bound that is too good, which must not be.
set -euo pipefail
cd "$(dirname "$0")"
if ! command -v gappa >/dev/null; then
    if ! { apt-get install -y gappa >/dev/null 2>&1 && command -v gappa >/dev/null; }; then
        echo "gappa: skipped (not installed, and apt cannot install it here)"
        exit 0
    fi
fi

# Allowed errors are m·2^(e − 12): 3.001 u, 2.52 u and 3.01 u with u = 2^e.
prove() { # file, format, e, range's exponent, m of |Δx|², of l, of k(l − l₀)/l
    local low=$((-$4)) e=$(($3 - 12))
    sed -e "s/FORMAT/$2/; s/SQUARED/$5b$e/g; s/LENGTH/$6b$e/g; s/STRETCH/$7b$e/g" \
        -e "s/LOW/1b$low/g; s/HIGH/1b$4/g; s/LEAST/1b$((2 * low))/g; s/MOST/1b$((2 * $4))/g" "$1.g" | timeout 60 gappa >/dev/null 2>&1
}
for file in length stretch; do
    prove $file ieee_64 -53 300 12292 10321 12328 || { echo "gappa: $file.g is not proved in f64"; exit 1; }
    prove $file ieee_32 -24 30 12292 10321 12328 || { echo "gappa: $file.g is not proved in f32"; exit 1; }
    if prove $file ieee_64 -53 300 12292 6000 6000; then
        echo "gappa: $file.g proves too much"
        exit 1
    fi
    echo "gappa: $file.g proved in f64 and f32"
done
