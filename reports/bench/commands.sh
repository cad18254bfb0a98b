#!/usr/bin/env bash
# A live check of `etalon bench` and `etalon diff`: 100 comparisons of the same thing with itself, and a
# rasterizer that was slowed down on purpose. About four minutes; ETALON names the binary.
set -euo pipefail
etalon=${ETALON:-etalon}
out=${1:?where benches go}
four=(perf/clear/size=256x256 perf/quad/size=256x256
    perf/overdraw/order=front-to-back/size=256x256 perf/state-changes/size=256x256)
two=(perf/overdraw/order=front-to-back/size=256x256 perf/quad/size=256x256)

for i in $(seq 0 25); do
    "$etalon" bench "${four[@]}" --rounds 12 --seconds 0.02 --adapter cpu --out "$out/same/$i" >/dev/null
done
for i in $(seq 1 25); do
    # 1 says that something is slower, which is part of the answer here.
    "$etalon" diff "$out/same/$((i - 1))" "$out/same/$i" --format json || [ $? -eq 1 ]
done >"$out/same.json"

"$etalon" bench "${two[@]}" --rounds 40 --seconds 0.03 --adapter cpu --out "$out/cpu" >/dev/null
for percent in 10 20 50; do
    "$etalon" bench "${two[@]}" --rounds 40 --seconds 0.03 --adapter "cpu:slower=$percent%" \
        --out "$out/slower-$percent" >/dev/null
    "$etalon" diff "$out/cpu" "$out/slower-$percent" >"$out/slower-$percent.txt" || [ $? -eq 1 ]
done
