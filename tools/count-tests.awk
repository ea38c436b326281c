# Counts what a verbose ctest log says: "passed failed". A CppUTest group counts with the tests it ran, and as one failure
# when it ended without its summary line (crash, time-out); every other entry counts as one.
#   7: OK (69 tests, 4 ran, 17 checks, ...)
#   7: Errors (2 failures, 69 tests, 4 ran, ...)
#   3/20 Test  #7: unit.Simd ....   Passed    0.01 sec
/^[0-9]+: (OK|Errors) \(/ {
  entry = $1 + 0
  match($0, /[0-9]+ ran,/)
  ran = substr($0, RSTART) + 0
  failures = match($0, /[0-9]+ failures/) ? substr($0, RSTART) + 0 : 0
  group_ran[entry] += ran
  group_failed[entry] += failures < ran ? failures : ran
  has_summary[entry] = 1
}
match($0, /^ *[0-9]+\/[0-9]+ Test +#[0-9]+: /) {
  entry = $0
  sub(/.*#/, "", entry)
  entry += 0
  good = $0 ~ / Passed /
  if (has_summary[entry]) {
    passed += group_ran[entry] - group_failed[entry]
    failed += group_failed[entry]
    if (!good && group_failed[entry] == 0) ++failed  # all tests passed and then it crashed on its way out
  } else if (good) ++passed
  else ++failed
}
END { print passed + 0, failed + 0 }
