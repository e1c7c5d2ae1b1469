#!/bin/sh
# A program built without the window: `view` is one line that names another way, and all else works.
#
#   sh tests/view/windowless.sh RHEO SCENE FOLDER
set -u
rheo=$1
scene=$2
folder=$3
fail() {
  echo "FAILED: $1"
  [ -f log ] && cat log
  exit 1
}
rm -rf "$folder"
mkdir -p "$folder" && cd "$folder" || exit 1

"$rheo" view "$scene" >output 2>log
[ $? = 2 ] || fail "view: another exit code than 2"
[ -s output ] && fail "view: writes to standard output"
[ "$(wc -l <log)" = 1 ] && grep -q "no window" log && grep -q "rheo render" log || fail "view: not one line that names rheo render"
[ "$(find . -type f | wc -l)" = 2 ] || fail "view: wrote files"

"$rheo" --help | grep -q "render" || fail "no help"
# The text of the options is the same, whether or not there is a window.
"$rheo" view --help | grep -q -- "--color" || fail "view --help"
"$rheo" render "$scene" -o pictures --duration 0.1 --frame-rate 20 --size 320x240 --quiet >log 2>&1 ||
  fail "render: exit code $?"
for k in 0 1 2; do
  [ -s "pictures/frames/frame_0000$k.png" ] || fail "render: no frame $k"
done
[ -s pictures/sheet.png ] || fail "render: no sheet"
echo passed
