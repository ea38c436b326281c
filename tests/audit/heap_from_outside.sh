#!/usr/bin/env bash
# Runs a command under the preloaded heap counter and holds its count against the program's own:
# heap_from_outside.sh BUILD COMMAND...   (COMMAND ends with startrack's line `run: PATH`)
# Passes when both are zero and a loop really ran.
set -euo pipefail
build=$1
shift
counts=$(mktemp)
output=$(mktemp)
trap 'rm -f "$counts" "$output"' EXIT

HEAP_COUNTER_OUT=$counts LD_PRELOAD=$build/libheap_counter.so "$@" > "$output"
run=$(sed -n 's/^run: //p' "$output" | tail -n 1)
inside=$(grep -o '"heap_calls_after_seal": *[0-9]*' "$run/summary.json" | grep -o '[0-9]*$')
read -r sealed outside < <(awk '{s += $2; c += $4} END {print s + 0, c + 0}' "$counts")

echo "heap calls after seal: $inside by the program, $outside from outside, $sealed loops"
[ "$sealed" -gt 0 ] || { echo "heap_from_outside: no thread was ever named st-loop"; exit 1; }
[ "$inside" -eq "$outside" ] || { echo "heap_from_outside: the two counts differ"; exit 1; }
[ "$outside" -eq 0 ] || { echo "heap_from_outside: the loop used the heap"; exit 1; }
