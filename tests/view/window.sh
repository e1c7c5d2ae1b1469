#!/bin/sh
# The real window under Xvfb, driven by xdotool: a drag, a slider, sizes, out of sight and back, a saved session,
# the end. Exit code 77: something that this needs is not installed.
#
#   sh tests/view/window.sh RHEO FOLDER
set -u
rheo=$1
folder=$2
for need in Xvfb xdotool import convert; do
  command -v "$need" >/dev/null || {
    echo "skipped: $need is missing (Debian packages xvfb, xdotool, imagemagick)"
    exit 77
  }
done
[ -e /usr/lib/x86_64-linux-gnu/libglfw.so.3 ] || ldconfig -p | grep -q libglfw.so.3 || {
  echo "skipped: libglfw.so.3 is missing (Debian package libglfw3)"
  exit 77
}
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1
xvfb=
program=
finish() {
  [ -z "$program" ] || kill "$program" 2>/dev/null
  [ -z "$xvfb" ] || kill "$xvfb" 2>/dev/null
}
trap finish EXIT
fail() {
  echo "FAILED: $1"
  [ -f log ] && cat log
  exit 1
}

cat >block.toml <<'SCENE'
title = "Block"
[mesh]
shape = "rectangle"
size = [0.1, 0.05]
nodes = [9, 5]
thickness = 0.05
[material]
lambda_ela = 4000
mu_ela = 1500
lambda_vis = 800
mu_vis = 300
density = 1000
[[fix]]
edges = "bottom"
[time]
duration = 5
SCENE

# Without a display: one line that names another way, and exit code 2.
env -u WAYLAND_DISPLAY DISPLAY= "$rheo" view block.toml >log 2>&1
[ $? = 2 ] || fail "no display: another exit code than 2"
[ "$(wc -l <log)" = 1 ] && grep -q "rheo render block.toml" log || fail "no display: not one line that names rheo render"

Xvfb -displayfd 3 -screen 0 2600x1500x24 -nolisten tcp 3>display 2>xvfb.log &
xvfb=$!
waited=0
until [ -s display ]; do
  sleep 0.1
  waited=$((waited + 1))
  [ $waited -lt 300 ] || fail "Xvfb does not start"
done
DISPLAY=:$(cat display)
export DISPLAY

"$rheo" view block.toml -o saved --close-after 120 >log 2>&1 &
program=$!
window=
waited=0
until [ -n "$window" ]; do
  sleep 0.2
  window=$(xdotool search --onlyvisible --name "Block - rheo" 2>/dev/null | head -n 1)
  waited=$((waited + 1))
  [ $waited -lt 300 ] || fail "no window"
  kill -0 "$program" 2>/dev/null || fail "the program has ended"
done
colours() { # how many a picture has
  import -window "$window" "$1.png" && convert "$1.png" -format %k info:
}
waited=0
until [ "$(colours start)" -gt 50 ]; do # until it has drawn
  sleep 0.2
  waited=$((waited + 1))
  [ $waited -lt 100 ] || fail "the window stays empty"
done

# Push: a brush that reaches from anywhere near, then a drag to the right.
press() { xdotool key --window "$window" "$1" && sleep 0.3; }
move() { xdotool mousemove --window "$window" "$1" "$2" && sleep 0.1; }
for k in 1 2 3 4 5 6 7 8 9 10; do press bracketright; done
move 900 200
move 905 202
xdotool mousedown 1
sleep 0.5
for x in 920 940 960 980 1000; do move $x 202; done
sleep 1
pushed=$(colours pushed)
xdotool mouseup 1
sleep 1
press ctrl+s
waited=0
until [ -s saved/session_001.toml ]; do
  sleep 0.2
  waited=$((waited + 1))
  [ $waited -lt 100 ] || fail "no session was saved"
done
[ "$pushed" -gt 200 ] || fail "pushed, the picture has $pushed colours only"
grep -q '^\[\[traction\]\]' saved/session_001.toml || fail "the drag is no traction in the session"

# Left alone it comes to rest, and then takes less than 2 % of a core: 10 of 500 hundredths of a second.
ticks() { awk '{ print $14 + $15 }' "/proc/$program/stat"; }
waited=0
while :; do
  before=$(ticks)
  sleep 5
  taken=$(($(ticks) - before))
  [ "$taken" -lt 10 ] && break
  waited=$((waited + 1))
  [ $waited -lt 12 ] || fail "not at rest after a minute: $taken hundredths of a second in 5 s"
done
echo "at rest: $taken hundredths of a second of processor time in 5 s"

# A slider of the material.
move 60 330
xdotool mousedown 1
sleep 0.3
xdotool mouseup 1
sleep 0.3

press shift+F12
[ -s saved/picture_001.png ] || sleep 2
[ -s saved/picture_001.png ] || fail "no picture was saved"

for size in "300 200" "2560 1440" "1280 720"; do
  # shellcheck disable=SC2086  # words are meant
  xdotool windowsize "$window" $size
  sleep 2
  name=size_$(echo "$size" | tr ' ' x)
  [ "$(colours "$name")" -gt 30 ] || fail "nothing to see at $size"
  [ "$(convert "$name.png" -format '%w %h' info:)" = "$size" ] || fail "another size than $size"
done
xdotool windowunmap "$window"
sleep 1
timeout 5 xdotool windowmap "$window"
sleep 1
kill -0 "$program" 2>/dev/null || fail "the program has ended while out of sight"

# Out of sight it has lost the focus, and no window manager gives it back.
waited=0
while kill -0 "$program" 2>/dev/null && [ $waited -lt 20 ]; do
  timeout 5 xdotool windowfocus "$window" mousemove --window "$window" 700 300 key ctrl+q 2>/dev/null
  sleep 0.5
  waited=$((waited + 1))
done
[ $waited -lt 20 ] || fail "it does not end by its key"
wait "$program"
code=$?
program=
[ $code = 0 ] || fail "exit code $code"
grep -Eq '^[0-9]+ frames in [0-9.]+ s, median [0-9.]+ ms, 99th percentile [0-9.]+ ms a frame; [0-9]+ steps to t = ' log ||
  fail "no summary line"

# What the hand did, again and headless.
"$rheo" run saved/session_001.toml -o again --quiet || fail "the session does not run"
hash=$(sed -n 's/^# state at its end.*: //p' saved/session_001.toml)
[ -n "$hash" ] && grep -q "\"state_hash\": \"$hash\"" again/run.json || fail "run again, the session ends elsewhere than at $hash"
cat log
echo passed
