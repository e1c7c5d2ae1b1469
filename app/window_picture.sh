#!/bin/sh
# Makes the README's picture of the window, app/pictures/window.png, under Xvfb: a slab is pulled by an edge.
#
#   sh app/window_picture.sh [RHEO]        needs xvfb, xdotool
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
rheo=${1:-$top/build/release/app/rheo}
folder=$(mktemp -d)
xvfb=
program=
finish() {
  if [ -n "$program" ]; then # before its display
    kill "$program" 2>/dev/null || true
    wait "$program" 2>/dev/null || true
  fi
  [ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$folder/display" 2>/dev/null &
xvfb=$!
until [ -s "$folder/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$folder/display")
export DISPLAY
"$rheo" view "$top/app/scenes/liver.toml" -o "$folder/saved" >/dev/null 2>&1 &
program=$!
window=
until [ -n "$window" ]; do
  sleep 0.5
  window=$(xdotool search --onlyvisible --name "rheo" | head -n 1)
done
sleep 8 # the scene's own load has come and gone
xdotool key --window "$window" g
xdotool mousemove --window "$window" 1048 215
sleep 0.5
xdotool mousedown 1
for k in 1 2 3 4 5 6 7 8 9; do
  xdotool mousemove --window "$window" $((1048 + 8 * k)) $((215 - 2 * k))
  sleep 0.05
done
sleep 0.6
xdotool key --window "$window" shift+F12
until [ -s "$folder/saved/picture_001.png" ]; do sleep 0.2; done
sleep 1
xdotool mouseup 1
cp "$folder/saved/picture_001.png" "$top/app/pictures/window.png"
echo "made $top/app/pictures/window.png"
