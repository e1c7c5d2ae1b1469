#!/bin/sh
# Builds and runs all tests, first as released, then under the address and undefined-behaviour sanitizers.
#
#   sh tests/run.sh                 both; missing Debian packages are installed, as root or with sudo
#   sh tests/run.sh release         only one of the presets release, asan, debug, tsan
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
cd "$top" || exit 1

. app/packages.sh
# shellcheck disable=SC2086  # words are meant
install_missing $build_packages $draw_packages $test_packages || exit 1

[ $# -gt 0 ] || set -- release asan
summary=
failed=0
for preset in "$@"; do
  echo "== $preset: build"
  start=$(date +%s)
  # (Twice: in a tree that was another compiler's, the first changes that and forgets the preset's other settings.)
  if cmake --preset "$preset" >/dev/null && cmake --preset "$preset" >/dev/null && cmake --build --preset "$preset"; then
    echo "== $preset: test"
    if ctest --preset "$preset" -j2 --no-tests=error; then result=passed; else
      result="FAILED ($(tr '\n' ' ' <"build/$preset/Testing/Temporary/LastTestsFailed.log"))"
    fi
  else
    result="did not build"
  fi
  [ "$result" = passed ] || failed=1
  summary="$summary
  $preset: $result in $(($(date +%s) - start)) s"
done
echo
echo "Summary:$summary"
exit "$failed"
