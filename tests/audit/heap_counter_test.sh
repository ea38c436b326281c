#!/usr/bin/env bash
# heap_from_outside.sh passes a loop without heap calls, and finds those of one that makes some: heap_counter_test.sh BUILD
set -euo pipefail
build=$1
here=$(dirname "$0")
run=$(mktemp -d)
trap 'rm -rf "$run"' EXIT

"$here/heap_from_outside.sh" "$build" "$build/heap_probe" 0 "$run"
if said=$("$here/heap_from_outside.sh" "$build" "$build/heap_probe" 3 "$run"); then
  echo "heap_counter_test: six heap calls were not found"
  exit 1
fi
grep -q '6 by the program, 6 from outside' <<< "$said" || { echo "heap_counter_test: $said"; exit 1; }
if said=$("$here/heap_from_outside.sh" "$build" bash -c "echo '{\"heap_calls_after_seal\": 0}' > '$run/summary.json'; echo 'run: $run'"); then
  echo "heap_counter_test: a run without a loop passed"
  exit 1
fi
grep -q 'no thread' <<< "$said"
