#!/usr/bin/env bash
# A sweep as a Slurm job array: a job for each of SHARDS parts, and one that puts the parts together.
#
#   data/cluster/slurm.sh SHARDS DESIGNS.csv SCENE --vary KEY=VALUES ...
#
# A part that is stopped (time limit, preemption, lost node) goes on from its `.part` file when Slurm starts it again. The
# folder of DESIGNS.csv is one that all nodes see. `SLICE=00:30:00` sets the time after which a job makes room for others;
# `SLIDER_CRANK` is the program, `CPUS` the cores of a job.
set -euo pipefail

shards="${1:?number of parts}" out="$(realpath "${2:?file of the designs}")"
shift 2
program="$(command -v "${SLIDER_CRANK:-slider-crank}")"
sweep="$(printf '%q ' "$program" sweep "$@")"
quoted="$(printf '%q' "$out")"

# Slurm signals the program a minute before the time limit: it keeps its rows and ends with 1, and the job is put back.
part="$quoted.\$SLURM_ARRAY_TASK_ID"
array="$(sbatch --parsable --array="1-$shards" --requeue --open-mode=append --time="${SLICE:-60}" --signal=TERM@60 \
    --cpus-per-task="${CPUS:-1}" --job-name=designs --output="$out.%a.log" <<JOB
#!/usr/bin/env bash
export RAYON_NUM_THREADS="\$SLURM_CPUS_PER_TASK"
srun --cpus-per-task="\$SLURM_CPUS_PER_TASK" $sweep --shard "\$SLURM_ARRAY_TASK_ID/$shards" --out $part && exit
status=\$?
[ ! -e $part.part ] || scontrol requeue "\${SLURM_ARRAY_JOB_ID}_\$SLURM_ARRAY_TASK_ID"
exit \$status
JOB
)"
parts="$(for part in $(seq "$shards"); do printf '%q ' "$out.$part"; done)"
sbatch --parsable --dependency="afterok:$array" --kill-on-invalid-dep=yes --job-name=whole --output="$out.log" <<JOB
#!/usr/bin/env bash
$(printf '%q ' "$program") sweep --percentiles --out $quoted --merge $parts && rm -- $parts
JOB
