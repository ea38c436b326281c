#!/usr/bin/env bash
# The audits audited: each must pass a clean tree and refuse one with a planted fault. selftest.sh AUDIT_FOLDER COMPILER
set -euo pipefail
audit=$1
compiler=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

fail() { echo "selftest: $1"; exit 1; }
# refuses SCRIPT FILE LINE: the script passes without the line and fails with it.
refuses() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree/$(dirname "$2")" "$tree/algo/core"
  printf '#include <cmath>\n#include "algo/core/pose.hpp"\n' > "$tree/algo/core/x.cpp"
  printf '// nothing\n' >> "$tree/$2"
  "$audit/$1" "$tree" > /dev/null || fail "$1 refuses a clean tree"
  printf '%s\n' "$3" >> "$tree/$2"
  if "$audit/$1" "$tree" > /dev/null; then fail "$1 lets pass in $2: $3"; fi
}
refuses includes.sh algo/core/y.hpp '#include "algo/depth/z.hpp"'
refuses includes.sh algo/depth/y.cpp '#include "hal/clock.hpp"'
refuses includes.sh algo/depth/y.cpp '  #  include <vector>'
refuses includes.sh algo/depth/y.cpp '#include <mutex>'
refuses includes.sh algo/depth/y.cpp '#include "y.hpp"'
refuses includes.sh hal/sim/y.cpp '#include "algo/depth/z.hpp"'
refuses includes.sh hal/y.cpp '#include "firmware_like/loop.hpp"'
refuses includes.sh firmware_like/y.cpp '#include "tools/startrack/commands.hpp"'
refuses includes.sh tools/startrack/y.cpp '#include "tests/x.hpp"'
refuses wording.sh hal/y.cpp '// TO''DO: later'
refuses wording.sh algo/core/y.hpp '// FIX''ME'

# refuses_code CODE: a library with this function is refused, one without is not.
library_of() {
  printf '%s\n' "$1" > "$tree/a.cpp"
  rm -f "$tree/liba.a"
  "$compiler" -std=c++20 -O2 -c "$tree/a.cpp" -o "$tree/a.o"
  ar rcs "$tree/liba.a" "$tree/a.o"
  "$audit/symbols.sh" "$tree/liba.a" > /dev/null
}
library_of '#include <cmath>
namespace st { double f(double x) { return std::sqrt(x) + std::floor(x); } }' || fail "symbols.sh refuses sqrt"
for code in '#include <vector>
namespace st { int* f(int n) { return new int[n]; } }' '#include <cmath>
namespace st { double f(double x) { return std::sin(x); } }' 'namespace st { void f(int x) { if (x) throw x; } }' '#include <ctime>
namespace st { long f() { return std::time(nullptr); } }' '#include <mutex>
namespace st { std::mutex m; void f() { m.lock(); } }' 'namespace st { int g(); int f() { static int x = g(); return x; } }'; do
  if library_of "$code"; then fail "symbols.sh lets pass: $code"; fi
done
echo "selftest: every planted fault was found"
