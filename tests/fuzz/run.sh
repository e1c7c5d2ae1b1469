#!/bin/sh
# Fuzzes the readers for longer than ctest does, one after the other; says what was executed, covered and found.
#
#   sh tests/fuzz/run.sh              40 minutes each: two hours in all
#   sh tests/fuzz/run.sh 5            5 minutes each
#   sh tests/fuzz/run.sh 5 scene      of one reader: scene, mesh or command_line
#
# Needs clang-14 and libclang-rt-14-dev. What it finds is in build/fuzz/findings; `build/fuzz/rheo_fuzz_scene FILE`
# shows a finding again.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
build=$top/build/fuzz
minutes=${1:-40}
[ $# -gt 1 ] && shift && readers=$* || readers="scene mesh command_line"
cmake "-DSOURCE=$top" "-DBUILD=$build" -DCLANG=clang++-14 -DGENERATOR=Ninja -P "$top/tests/fuzz/build.cmake" || exit 1
cd "$build" || exit 1

for reader in $readers; do
  seeds=$top/tests/fuzz/corpus/$reader
  [ "$reader" = scene ] && seeds="$seeds $top/app/scenes"
  [ "$reader" = mesh ] && seeds="$seeds $top/tests/data/msh"
  end=$(($(date +%s) + 60 * minutes))
  executed=0
  runs=0
  # A finding ends a run: the next goes on from the same corpus.
  while left=$((end - $(date +%s))) && [ "$left" -gt 0 ]; do
    # shellcheck disable=SC2086  # words are meant
    "./rheo_fuzz_$reader" "-max_total_time=$left" -max_len=16384 -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
      "-artifact_prefix=findings/${reader}_" "-dict=$top/tests/fuzz/$reader.dict" "corpus_$reader" $seeds 2>"$reader.log"
    more=$(sed -n 's/^stat::number_of_executed_units: *//p' "$reader.log")
    executed=$((executed + ${more:-0}))
    runs=$((runs + 1))
  done
  found=$(find findings -name "${reader}_*" | wc -l)
  echo "$reader: $executed executions in $runs runs, $(grep -ao 'cov: [0-9]* ft: [0-9]*' "$reader.log" | tail -n 1)," \
    "$found findings in $build/findings"
done
