#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that Talus is built from: as root directly, otherwise with sudo.
# Does nothing, and needs no network, when they are all there.
#   deploy/install-dependencies.sh            what building, running and testing need
#   deploy/install-dependencies.sh --checks   also clang, clang-format and clang-tidy
set -euo pipefail

packages=(
    gcc libc6-dev cmake ninja-build pkg-config binutils git ca-certificates curl
    libhdf5-dev libcairo2-dev libjansson-dev libmicrohttpd-dev libsqlite3-dev
    libcurl4-openssl-dev libssl-dev libcmocka-dev
    fonts-dejavu-core python3 python3-numpy python3-h5py
)
checks=(clang libomp-dev clang-format clang-tidy)

case "${1:-}" in
'') ;;
--checks) packages+=("${checks[@]}") ;;
*)
    echo "usage: $0 [--checks]" >&2
    exit 2
    ;;
esac

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing+=("$package")
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
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
