#!/bin/sh
# Frame times of the real window under Xvfb, of a block of tissue that is pulled to and fro: a Markdown table.
#
#   sh tests/view/frame_times.sh [RHEO] [SECONDS]        needs xvfb; by default the release build, 10 s a row
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
rheo=${1:-$top/build/release/app/rheo}
seconds=${2:-10}
folder=$(mktemp -d)
xvfb=
finish() {
  [ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$folder/display" 2>/dev/null &
xvfb=$!
until [ -s "$folder/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$folder/display")
export DISPLAY

# scene WIDTH HEIGHT COLUMNS ROWS: E = 20 kPa, nu = 0.4, half of it relaxing within a second; a pull of +-1 kPa at 1 Hz.
scene() {
  cat <<SCENE
title = "Block"
[mesh]
shape = "rectangle"
size = [$1, $2]
nodes = [$3, $4]
diagonal = "alternating"
thickness = 0.02
[material]
density = 1000
poisson = 0.4
[material.elastic]
young = 10e3
[[material.maxwell]]
young_ela = 10e3
time = 0.5
[[fix]]
edges = "left"
[[traction]]
edges = "right"
keys = [$(awk 'BEGIN { for (k = 0; k < 240; ++k) printf "[%g, %d, 0], ", 0.5 * k, k % 2 ? 1000 : -1000 }')]
[time]
duration = 120
SCENE
}

echo "| triangles | frames a second | median, ms a frame | 99 % | physics steps a second | real time |"
echo "|---|---|---|---|---|---|"
for size in "1.0 0.25 5 2" "0.1 0.05 33 17" "0.1 0.05 101 51" "0.1 0.05 225 113"; do
  # shellcheck disable=SC2086  # words are meant
  set -- $size
  scene "$@" >"$folder/block.toml"
  "$rheo" view "$folder/block.toml" --close-after "$seconds" |
    sed 's/,//g' | awk -v n=$((2 * ($3 - 1) * ($4 - 1))) '/ frames in / {
      print "| " n " | " sprintf("%.0f", $1 / $4) " | " $7 " | " $11 " | " sprintf("%.0f", $15 / $4) " | x" \
            sprintf("%.2f", $20 / $4) " |" }'
done
