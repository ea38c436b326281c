#!/usr/bin/env bash
# Our recordings under the stock fakenect library: it is loaded instead of the Kinect's, hands out our recording as a live
# device, and what comes out of it must be our frames, bit by bit. Usage: stock_fakenect.sh STARTRACK FAKENECT_FOLDER
set -euo pipefail
program=$1 library=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" record "$work/ours" --source sim:circle --robot sim --seconds 2 > /dev/null
head -2 "$work/ours/robot.log" | grep -q '# model create2'
for way in rx tx; do grep -q " $way " "$work/ours/robot.log"; done
LD_LIBRARY_PATH=$library FAKENECT_PATH="$work/ours" \
  "$program" record "$work/theirs" --source kinect --seconds 3 > /dev/null 2> "$work/log"
frames() { (cd "$1" && for file in d-*; do tail -c 614400 "$file" | cksum; done | sort -u); }
frames "$work/ours" > "$work/a"
frames "$work/theirs" > "$work/b"
foreign=$(comm -13 "$work/a" "$work/b" | wc -l)
shared=$(comm -12 "$work/a" "$work/b" | wc -l)
echo "stock fakenect: $shared frames came out as they went in, $foreign did not"
[ "$foreign" = 0 ] && [ "$shared" -ge 20 ]
