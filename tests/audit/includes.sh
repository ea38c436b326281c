#!/usr/bin/env bash
# The dependency rule: algo/core <- algo/*, algo/core <- hal, algo and hal <- firmware_like <- tools, tests.
# includes.sh ROOT lists every include that points the wrong way, and what algo may not use at all.
set -euo pipefail
cd "$1"

# What algo may take from the standard library: nothing with heap, files, time, threads or exceptions at its heart.
std='algorithm|array|bit|cassert|cfloat|climits|cmath|compare|concepts|cstddef|cstdint|cstring|initializer_list|iterator|limits|numeric|optional|span|string_view|tuple|type_traits|utility'

folders=()
for folder in algo hal firmware_like tools tests; do [ -d "$folder" ] && folders+=("$folder"); done
grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.hpp' --include='*.cpp' --include='*.h' --include='*.inc' "${folders[@]}" |
  awk -v std="^(${std})\$" '
    # file:line:#include "x" or <x>
    {
      split($0, part, ":"); file = part[1]
      what = $0; sub(/^[^:]*:[^:]*:[[:space:]]*#[[:space:]]*include[[:space:]]*/, "", what)
      quoted = substr(what, 1, 1) == "\""
      sub(/^["<]/, "", what); sub(/[">].*/, "", what)
      ours = what ~ /^(algo|hal|firmware_like|tools|tests)\//
      if (file ~ /^algo\/core\//)          ok = ours ? what ~ /^algo\/core\// : what ~ std || what ~ /^(Eigen|hwy)\//
      else if (file ~ /^algo\//)           ok = ours ? what ~ /^algo\//       : what ~ std || what ~ /^(Eigen|hwy)\//
      else if (file ~ /^hal\//)            ok = !ours || what ~ /^(algo\/core|hal)\//
      else if (file ~ /^firmware_like\//)  ok = !ours || what ~ /^(algo|hal|firmware_like)\//
      else if (file ~ /^tools\//)          ok = !ours || what !~ /^tests\//
      else                                 ok = 1
      if (quoted && !ours && what !~ /^hwy\//) ok = 0   # ours are named from the top folder
      if (!ok) { print part[1] ":" part[2] ": may not include " what; bad = 1 }
    }
    END { exit bad }'
