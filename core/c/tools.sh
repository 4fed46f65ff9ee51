# shellcheck shell=bash
# The tools of the C interface, installed where absent: cbindgen by cargo, compilers, valgrind and QEMU by Debian's
# packages. What cannot be had here skips the part that needs it, and says so; with CI=true that is a failure. Sourced.

tools=$(realpath -m "${CARGO_TARGET_DIR:-../../target}")/tools
PATH=$tools/bin:$PATH

has() { command -v "$1" >/dev/null; }

skipped() { # which part, what it needs
    echo "c: skipped: $1 needs $2"
    [ "${CI:-}" != true ] || { echo "c: with CI=true nothing may be skipped"; exit 1; }
}

# This very version: another may write the same header in another way.
cbindgen_here() {
    local version=0.29.2
    has cbindgen && [ "$(cbindgen --version)" = "cbindgen $version" ] && return
    # Without optimisation: it runs once and is built in half the time.
    cargo install --quiet --debug --locked --root "$tools" "cbindgen@$version"
}

# Installs the packages of the commands that are missing, where that can be done.
install_packages() { # command:package ...
    local pair packages=()
    for pair in "$@"; do
        has "${pair%%:*}" || packages+=("${pair#*:}")
    done
    if [ ${#packages[@]} -gt 0 ] && has apt-get && [ "$(id -u)" = 0 ]; then
        export DEBIAN_FRONTEND=noninteractive
        if ! { apt-get update -qq && apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null; }; then
            echo "c: apt-get could not install ${packages[*]}"
        fi
    fi
}
