# shellcheck shell=bash
# What the check needs, installed where absent. Sourced by check.sh.

# Makes `compile` (arguments of cargo) work for a target: with rustup's library where it can be had, else with Debian's
# compiler, which builds core from its own sources. (Allowed on a stable compiler by RUSTC_BOOTSTRAP.)
compiler_for() {
    compile=(cargo)
    if [ -z "${FIRMWARE_DEBIAN:-}" ]; then
        rustup target list --installed 2>/dev/null | grep -qx "$1" && return
        timeout 120 rustup target add "$1" >/dev/null 2>&1 && return
    fi
    local lld variable
    lld=$(compgen -c ld.lld | sort | head -n 1 || true)
    if ! [ -d /usr/lib/rustlib/src/rust/library/core ] || [ -z "$lld" ]; then
        command -v apt-get >/dev/null || { echo "firmware: needs 'rustup target add $1'"; exit 1; }
        export DEBIAN_FRONTEND=noninteractive
        apt-get update -qq
        apt-get install -y -qq --no-install-recommends rustc-web cargo-web rust-web-src lld >/dev/null
        lld=ld.lld
    fi
    variable=CARGO_TARGET_$(tr 'a-z-' 'A-Z_' <<<"$1")_LINKER
    [ "${1%%-*}" != wasm32 ] || lld=${lld/ld.lld/wasm-ld}
    compile=(env -u RUSTUP_TOOLCHAIN -u CARGO RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 "$variable=$lld"
        CARGO_UNSTABLE_BUILD_STD=core /usr/bin/cargo)
}

# The version of the compiler that was last chosen.
compiler_version() { if [ "${compile[0]}" = cargo ]; then rustc --version; else /usr/bin/rustc --version; fi | cut -d' ' -f2; }

# Emulators by Debian's packages, where there is no such command yet; elsewhere install QEMU 7 or newer and node 18 or
# newer yourself.
install_tools() {
    local command packages=()
    while read -r command package; do
        command -v "$command" >/dev/null || packages+=("$package")
    done <<'TOOLS'
qemu-system-arm qemu-system-arm
qemu-system-aarch64 qemu-system-arm
qemu-system-riscv32 qemu-system-misc
qemu-system-riscv64 qemu-system-misc
node nodejs
size binutils
llvm-objdump llvm
TOOLS
    [ ${#packages[@]} -gt 0 ] || return 0
    command -v apt-get >/dev/null || { echo "firmware: please install ${packages[*]}"; exit 1; }
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null
}
