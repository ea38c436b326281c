#!/usr/bin/env bash
# What the Release library of algo asks of the rest of the world: symbols.sh LIBRARY.
# A short list is allowed; a heap call, an exception, a lock, a clock or a libm function whose bits depend on the CPU is
# none of it. sqrt, floor and their like are exact everywhere.
set -euo pipefail
library=$1
allowed='^(st::.*|.* st::.*|hwy::.*|mem(cpy|move|set|cmp|chr)|str(len|cmp|ncmp)|(sqrt|fabs|floor|ceil|trunc|rint|nearbyint|round|lrint|llrint|lround|fma|fmod)f?|__stack_chk_fail|_GLOBAL_OFFSET_TABLE_)$'

undefined=$(nm -C --undefined-only "$library" | sed -nE 's/^ +[Uw] //p' | sort -u)
nm --defined-only "$library" | grep ' [TtWw] ' > /dev/null || { echo "symbols: $library is empty"; exit 1; }
bad=$(grep -vE "$allowed" <<< "$undefined" || true)
if [ -n "$bad" ]; then
  echo "algo may not use:"
  while read -r symbol; do
    users=$(nm -AC --undefined-only "$library" | grep -F " $symbol" | sed -E 's/^[^:]*:([^:]*):.*/\1/' | sort -u | tr '\n' ' ')
    echo "  $symbol   in $users"
  done <<< "$bad"
  exit 1
fi
