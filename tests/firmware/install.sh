# What the check needs, installed where absent. Sourced by check.sh.

# Adds a rustup target.
have_target() {
    rustup target list --installed 2>/dev/null | grep -qx "$1" || timeout 120 rustup target add "$1" >/dev/null 2>&1 ||
        { echo "firmware: no target $1: 'rustup target add $1' failed"; exit 1; }
}

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
TOOLS
    [ ${#packages[@]} -gt 0 ] || return 0
    command -v apt-get >/dev/null || { echo "firmware: please install ${packages[*]}"; exit 1; }
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends "${packages[@]}" >/dev/null
}
