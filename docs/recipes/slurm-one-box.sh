#!/bin/sh
# Slurm on this one machine, without systemd and munge: for trying job arrays, not for sharing a machine.
#
#   slurm-one-box.sh start FOLDER    all files of the daemons in FOLDER
#   slurm-one-box.sh stop FOLDER
#
# After `start`: export SLURM_CONF=FOLDER/slurm.conf. Needs Debian's slurm-wlm and root. Nobody is asked who they are
# (auth/none): whoever reaches the ports can run anything as root. Keep them behind a firewall, and stop when done.
set -eu

usage() {
    echo "usage: $0 start FOLDER | stop FOLDER" >&2
    exit 2
}

[ $# -ge 2 ] || usage
action=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)

stop() {
    for file in "$folder"/*.pid; do
        [ -e "$file" ] || continue
        pid=$(cat "$file")
        kill "$pid" 2>/dev/null || true
        for _ in $(seq 50); do
            kill -0 "$pid" 2>/dev/null || break
            sleep 0.1
        done
        kill -KILL "$pid" 2>/dev/null || true
        rm -f "$file"
    done
}

start() {
    port=${SLURM_ONE_BOX_PORT:-26817}
    cpus=$(nproc)
    host=$(hostname -s)
    mkdir -p "$folder/state" "$folder/spool"
    {
        echo "ClusterName=one-box"
        echo "SlurmctldHost=$host(127.0.0.1)"
        echo "SlurmUser=root"
        echo "SlurmdUser=root"
        echo "AuthType=auth/none"
        echo "CredType=cred/none"
        echo "ProctrackType=proctrack/linuxproc"
        echo "TaskPlugin=task/none"
        echo "MpiDefault=none"
        echo "SwitchType=switch/none"
        echo "JobAcctGatherType=jobacct_gather/none"
        echo "AccountingStorageType=accounting_storage/none"
        echo "SelectType=select/cons_tres"
        echo "SelectTypeParameters=CR_CPU"
        echo "ReturnToService=2"
        echo "SlurmctldPort=$port"
        echo "SlurmctldPidFile=$folder/slurmctld.pid"
        echo "SlurmctldLogFile=$folder/slurmctld.log"
        echo "SlurmdPidFile=$folder/slurmd.pid"
        echo "SlurmdLogFile=$folder/slurmd.log"
        echo "SlurmdSpoolDir=$folder/spool"
        echo "StateSaveLocation=$folder/state"
        echo "NodeName=box NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=$cpus State=UNKNOWN"
        echo "PartitionName=all Nodes=ALL Default=YES State=UP"
    } >"$folder/slurm.conf"
    export SLURM_CONF="$folder/slurm.conf"
    slurmctld -c -f "$SLURM_CONF"
    slurmd -c -N box -f "$SLURM_CONF"
    for _ in $(seq 300); do
        if [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ]; then
            echo "export SLURM_CONF=$SLURM_CONF"
            return
        fi
        sleep 0.1
    done
    echo "Slurm did not come up within 30 s; its logs end in:" >&2
    for log in "$folder"/*.log; do
        tail -n 10 "$log" >&2 || true
    done
    stop
    exit 1
}

case $action in
    start) start ;;
    stop) stop ;;
    *) usage ;;
esac
