#!/usr/bin/env bash
# Tries the recipes on this machine, as root: a job array whose first part is stopped and goes on, GNU parallel, and that both give
# the designs of one sweep to the byte. Exit status 77: there is no Slurm to be had.
#
#   data/cluster/try.sh target/release/slider-crank
set -euo pipefail

here="$(dirname "$(realpath "${BASH_SOURCE[0]}")")"
export SLIDER_CRANK="$(realpath "${1:?the program}")"
folder="$(mktemp -d)"
chmod 755 "$folder" # munge asks for it
trap '"$here/local-slurm.sh" stop "$folder/slurm"; sleep 1; rm -rf "$folder"' EXIT
"$here/local-slurm.sh" start "$folder/slurm" || exit 77
export SLURM_CONF="$folder/slurm/slurm.conf"
cd "$folder"

sweep=("$here/../spring-press.toml" --vary geometry.offset=-5mm:5mm:10001)
"$SLIDER_CRANK" sweep "${sweep[@]}" --percentiles --out whole.csv >whole.txt
whole="$("$here/slurm.sh" 3 designs.csv "${sweep[@]}")"
state() {
    squeue --noheader --array --format '%i %T' | awk -v id="$1" '$1 == id { print $2 }'
}
first="$(squeue --noheader --array --format %i | grep '_1$')"
for _ in $(seq 300); do
    [ "$(state "$first")" != RUNNING ] || [ ! -s designs.csv.1.part ] || break
    sleep 0.1
done
scancel --signal=TERM "$first"
for _ in $(seq 300); do
    [ "$(state "$first")" != PENDING ] || break
    sleep 0.1
done
# Slurm would wait two minutes.
scontrol update "JobId=$first" StartTime=now
for _ in $(seq 600); do
    [ -n "$(state "$whole")" ] || break
    sleep 0.5
done
cat designs.csv.1.log designs.csv.log
grep -q 'interrupted before design' designs.csv.1.log
cmp whole.csv designs.csv

command -v parallel >/dev/null || DEBIAN_FRONTEND=noninteractive apt-get install -y -qq parallel >/dev/null
"$here/parallel.sh" 5 parallel.csv "${sweep[@]}" >parallel.txt
cmp whole.csv parallel.csv
# Ranges and percentiles of the parts together are those of the whole.
diff <(grep -A99 '^figure' whole.txt) <(grep -A99 '^figure' parallel.txt)
echo 'job array and GNU parallel give the whole, to the byte'
