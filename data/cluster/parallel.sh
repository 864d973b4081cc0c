#!/usr/bin/env bash
# A sweep in parts on this machine and others over ssh, by GNU parallel, without a scheduler.
#
#   HOSTS=:,alice,bob data/cluster/parallel.sh SHARDS DESIGNS.csv SCENE --vary KEY=VALUES ...
#
# `:` is this machine. The machines share the present folder, have the program on their path and one core for each part
# that runs there. The same command again does what is missing.
set -euo pipefail

shards="${1:?number of parts}" out="${2:?file of the designs}"
shift 2
program="${SLIDER_CRANK:-slider-crank}"
sweep="RAYON_NUM_THREADS=1 $(printf '%q ' "$program" sweep "$@")"
seq "$shards" | parallel --will-cite --sshlogin "${HOSTS:-:}" --workdir . --retries 3 --halt soon,fail=1 \
    "[ -e $(printf '%q' "$out").{} ] || $sweep --shard {}/$shards --out $(printf '%q' "$out").{}" >/dev/null
mapfile -t parts < <(seq -f "$out.%g" "$shards")
"$program" sweep --percentiles --out "$out" --merge "${parts[@]}"
rm -- "${parts[@]}"
