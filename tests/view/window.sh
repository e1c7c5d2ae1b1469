#!/bin/sh
# The real window under Xvfb, driven by xdotool, with a window manager (twm): a drag, a slider, sizes, minimised and
# back, a saved session, the end by its key, by the window manager, by a signal and by itself, and the display that goes
# away under it (exit code 4). Exit code 77: something that this needs is not installed.
#
#   sh tests/view/window.sh RHEO FOLDER
set -u
rheo=$1
folder=$2
for need in Xvfb xdotool import convert twm; do
  command -v "$need" >/dev/null || {
    echo "skipped: $need is missing (Debian packages xvfb, xdotool, imagemagick, twm)"
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
manager=
program=
finish() {
  [ -z "$manager" ] || kill "$manager" 2>/dev/null
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

Xvfb -displayfd 3 -screen 0 2800x1700x24 -nolisten tcp 3>display 2>xvfb.log &
xvfb=$!
waited=0
until [ -s display ]; do
  sleep 0.1
  waited=$((waited + 1))
  [ $waited -lt 300 ] || fail "Xvfb does not start"
done
DISPLAY=:$(cat display)
export DISPLAY

# Windows are placed at once; Alt with a click closes one. The one font is the server's own.
cat >twmrc <<'RC'
TitleFont "fixed"
ResizeFont "fixed"
MenuFont "fixed"
IconFont "fixed"
IconManagerFont "fixed"
RandomPlacement
NoGrabServer
Button1 = m : window : f.delete
RC
LC_ALL=C twm -f twmrc >twm.log 2>&1 &
manager=$!
sleep 1
kill -0 "$manager" 2>/dev/null || fail "twm does not start: $(cat twm.log)"

# start SCENE TITLE ARGUMENT...: the program in $program, its window in $window.
start() {
  scene=$1
  title=$2
  shift 2
  "$rheo" view "$scene" "$@" >log 2>&1 &
  program=$!
  window=
  waited=0
  until [ -n "$window" ]; do
    sleep 0.2
    window=$(xdotool search --onlyvisible --name "^$title - rheo$" 2>/dev/null | tail -n 1)
    waited=$((waited + 1))
    [ $waited -lt 300 ] || fail "no window"
    kill -0 "$program" 2>/dev/null || fail "the program has ended"
  done
}

# ends CODE LINES WHAT: the program ends, with a summary and so many lines on standard error.
ends() {
  waited=0
  while kill -0 "$program" 2>/dev/null; do
    sleep 0.2
    waited=$((waited + 1))
    [ $waited -lt 100 ] || fail "$3: it goes on"
  done
  wait "$program"
  code=$?
  program=
  [ $code = "$1" ] || fail "$3: exit code $code instead of $1"
  summary='^[0-9]+ frames in [0-9.]+ s, median [0-9.]+ ms, 99th percentile [0-9.]+ ms a frame; [0-9]+ steps to t = '
  grep -Eq "$summary" log || fail "$3: no summary line"
  [ "$(grep -Evc "$summary" log)" = "$2" ] || fail "$3: not $2 lines beside the summary"
}

start block.toml Block -o saved --close-after 180
colours() { # how many a picture has
  timeout 30 import -window "$window" "$1.png" && convert "$1.png" -format %k info:
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
xdotool windowfocus "$window" mousemove --window "$window" 700 300 key ctrl+q
ends 0 0 "its key"

# What the hand did, again and headless.
"$rheo" run saved/session_001.toml -o again --quiet || fail "the session does not run"
hash=$(sed -n 's/^# state at its end.*: //p' saved/session_001.toml)
[ -n "$hash" ] && grep -q "\"state_hash\": \"$hash\"" again/run.json || fail "run again, the session ends elsewhere than at $hash"
cat log

# Minimised: it draws nothing and goes on; afterwards the picture is back. A body that is always pulled to and fro.
sed 's/Block/Pulled/' block.toml >pulled.toml
cat >>pulled.toml <<SCENE
[[traction]]
edges = "right"
keys = [$(awk 'BEGIN { for (k = 0; k < 400; ++k) printf "[%g, %d, 0], ", 0.25 * k, k % 2 ? 200 : -200 }')]
SCENE
sed -i 's/^duration = 5$/duration = 100/' pulled.toml
start pulled.toml Pulled
drawing() { awk '{ print $14 + $15 }' "/proc/$program/task/$program/stat"; } # of the thread that draws [1/100 s]
waited=0
until [ "$(colours pulled)" -gt 50 ]; do
  sleep 0.2
  waited=$((waited + 1))
  [ $waited -lt 100 ] || fail "the window stays empty"
done
before=$(drawing)
sleep 4
shown=$(($(drawing) - before))
xdotool windowminimize "$window"
sleep 1
xdotool search --onlyvisible --name "^Pulled - rheo$" 2>/dev/null | grep -q "$window" && fail "it is not minimised"
before=$(drawing)
all=$(ticks)
sleep 4
hidden=$(($(drawing) - before))
all=$(($(ticks) - all))
echo "drawing: $shown hundredths of a second in 4 s shown, $hidden in 4 s minimised; all threads then $all"
[ "$shown" -gt 4 ] || fail "shown, it draws nothing of a body that moves"
[ $((4 * hidden)) -lt "$shown" ] || fail "minimised, it draws: $hidden hundredths of a second against $shown"
[ "$all" -gt "$hidden" ] || fail "minimised, the physics stands"
kill -0 "$program" 2>/dev/null || fail "minimised, the program has ended"
xdotool windowmap "$window"
waited=0
until [ "$(colours restored)" -gt 50 ]; do
  sleep 0.2
  waited=$((waited + 1))
  [ $waited -lt 100 ] || fail "restored, the window stays empty"
done
before=$(drawing)
sleep 1
[ $(($(drawing) - before)) -gt 1 ] || fail "restored, it draws nothing"

# Closed by the window manager.
xdotool mousemove --window "$window" 700 300 keydown alt click 1 keyup alt
ends 0 0 "the window manager"

# Told to.
start block.toml Block
kill -TERM "$program"
ends 143 1 "SIGTERM"

# By itself, and in silence.
"$rheo" view block.toml --close-after 1 --quiet >log 2>&1 || fail "--close-after: exit code $?"
[ -s log ] && fail "--quiet: it writes"

# The display goes away under it, while it records what moves.
start pulled.toml Pulled -o lost
press F9
waited=0
until [ -s lost/frames_001/frame_00003.png ]; do
  sleep 0.2
  waited=$((waited + 1))
  [ $waited -lt 100 ] || fail "nothing is recorded"
done
kill -KILL "$xvfb"
xvfb=
ends 4 1 "no display any more"
for frame in lost/frames_001/*.png; do
  convert "$frame" -format '' info: || fail "no display any more: $frame is not whole"
done
echo passed
