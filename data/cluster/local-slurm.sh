#!/usr/bin/env bash
# A Slurm of one node on this machine, to try job arrays on: installs the packages of Debian or Ubuntu, writes a
# configuration into FOLDER and starts the daemons, as root. `local-slurm.sh stop FOLDER` ends them.
#
#   data/cluster/local-slurm.sh start /tmp/slurm
#   export SLURM_CONF=/tmp/slurm/slurm.conf
set -euo pipefail

action="${1:?start or stop}"
folder="$(realpath -m "${2:?a folder for configuration and state}")"

if [ "$action" = stop ]; then
    for daemon in slurmd slurmctld munged; do
        [ ! -s "$folder/$daemon.pid" ] || kill "$(cat "$folder/$daemon.pid")" 2>/dev/null || true
    done
    exit
fi

if ! command -v slurmctld munged >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq slurm-wlm munge >/dev/null
fi

mkdir -p "$folder/state" "$folder/spool"
[ -s "$folder/munge.key" ] || (umask 077 && dd if=/dev/urandom of="$folder/munge.key" bs=1024 count=1 status=none)
host="$(hostname -s)"
cat >"$folder/slurm.conf" <<CONF
ClusterName=local
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1
MinJobAge=3600
ReturnToService=2
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$folder/slurm.conf"
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munged.seed"
slurmctld
slurmd -N "$host"
for _ in $(seq 60); do
    # The node is ready.
    ! sinfo -h -o %T 2>/dev/null | grep -q '^idle' || exit 0
    sleep 0.5
done
tail -n 20 "$folder"/*.log >&2
exit 1
