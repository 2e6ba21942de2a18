#!/usr/bin/env bash
# Installs what pip cannot: OpenGL without a display, for pictures of the scene. Driving and training need none of it.
set -euo pipefail

packages=(libegl1 libgl1-mesa-dri libopengl0 libosmesa6)

missing=()
for package in "${packages[@]}"; do
    dpkg-query --show --showformat '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
        missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
    exit 0
fi

sudo=()
if [ "$(id -u)" -ne 0 ]; then
    sudo=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get update --quiet --quiet
"${sudo[@]}" apt-get install --quiet --quiet --yes --no-install-recommends "${missing[@]}"
