#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that Talus is built from: as root directly, otherwise with sudo.
# Does nothing, and needs no network, when they are all there.
#   deploy/install-dependencies.sh [OPTION...]   what building, running and testing need, and
#       --checks     clang, clang-format, clang-tidy, valgrind, qemu-user, nginx, caddy,
#                    promtool: what .ci/run uses (Debian starts three of them: `systemctl
#                    disable --now nginx caddy prometheus`)
#       --aarch64    the cross compiler and libraries of the preset aarch64 (adds the architecture
#                    arm64 to dpkg)
#       --contract   Node.js and npm, for the tests with the label contract
#       --coverage   gcovr
set -euo pipefail

packages=(
    gcc libc6-dev cmake ninja-build pkg-config binutils git ca-certificates curl
    libhdf5-dev libcairo2-dev libjansson-dev libmicrohttpd-dev libsqlite3-dev
    libcurl4-openssl-dev libssl-dev libcmocka-dev
    fonts-dejavu-core python3 python3-numpy python3-h5py
)
add_architecture=
for option in "$@"; do
    case "$option" in
    --checks)
        packages+=(clang libomp-dev clang-format clang-tidy valgrind qemu-user
            nginx-light caddy openssl prometheus)
        ;;
    --aarch64)
        add_architecture=arm64
        packages+=(gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user
            libgomp1:arm64 libcmocka-dev:arm64)
        ;;
    --contract)
        # Node.js from elsewhere brings an npm of its own, which Debian's would exclude.
        if ! command -v npm >/dev/null; then
            packages+=(nodejs npm)
        fi
        ;;
    --coverage) packages+=(gcovr) ;;
    *)
        echo "usage: $0 [--checks] [--aarch64] [--contract] [--coverage]" >&2
        exit 2
        ;;
    esac
done

# With several architectures, a name without one means the machine's own.
is_installed() {
    local name=${1%:*} architecture=${1##*:}
    [ "$architecture" != "$name" ] || architecture="all|$(dpkg --print-architecture)"
    dpkg-query --show --showformat='${Architecture} ${db:Status-Status}\n' "$name" 2>/dev/null |
        grep -qxE "($architecture) installed"
}

missing=()
for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "$0: run this as root (there is no sudo): apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "installing: ${missing[*]}"
if [ -n "$add_architecture" ]; then
    "${as_root[@]}" dpkg --add-architecture "$add_architecture"
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
