#!/bin/sh
# From a bare Debian 12 to the paper's experiment: installs what is missing, builds the program, draws the beam.
#
#   sh app/demo.sh        as root or with sudo; from any folder; the pictures are in out/beam
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top"

. app/packages.sh
# shellcheck disable=SC2086  # words are meant
install_missing $build_packages $draw_packages

build=build/demo
echo "Building rheo in $top/$build"
cmake --preset release -B "$build" -DRHEO_TESTS=OFF -DRHEO_BENCH=OFF >/dev/null
cmake --build "$build" --target rheo_app

echo "Drawing the paper's beam: rheo render app/scenes/beam.toml"
exec "$build/app/rheo" render app/scenes/beam.toml -o out/beam --force
