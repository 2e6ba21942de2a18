#!/usr/bin/env bash
# Installs what pip cannot: OpenGL without a display, for pictures of the scene; Xvfb, a display without a screen, to test windows;
# Chromium and npm, to test the live page and to build it. Driving and training need none of it, and neither does looking at the live page.
set -euo pipefail

packages=(libegl1 libgl1-mesa-dri libopengl0 libosmesa6 xvfb)
# These may have come from elsewhere than from the distribution.
if ! command -v chromium chromium-browser google-chrome >/dev/null; then
    packages+=(chromium)
fi
if ! command -v npm >/dev/null; then
    packages+=(nodejs npm)
fi

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
