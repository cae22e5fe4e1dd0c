#!/bin/sh
# Slurm on this one machine, without systemd and munge: for trying job arrays, not for sharing a machine.
#
#   slurm-one-box.sh start FOLDER [NODES]    daemons as NODES nodes (1); all their files in FOLDER
#   slurm-one-box.sh stop FOLDER
#
# Afterwards: export SLURM_CONF=FOLDER/slurm.conf. Needs Debian's slurm-wlm and root. Nobody is asked who they are
# (auth/none), so everybody on the machine may do as root does: the ports are bound, and should stay, behind a firewall.
set -eu

usage() {
    echo "usage: $0 start FOLDER [NODES] | stop FOLDER" >&2
    exit 2
}

[ $# -ge 2 ] || usage
action=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
nodes=${3:-1}

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
    mkdir -p "$folder/state"
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
        echo "SlurmdPidFile=$folder/%n.pid"
        echo "SlurmdLogFile=$folder/%n.log"
        echo "SlurmdSpoolDir=$folder/%n"
        echo "StateSaveLocation=$folder/state"
        for node in $(seq "$nodes"); do
            echo "NodeName=box$node NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + node)) CPUs=$cpus State=UNKNOWN"
        done
        echo "PartitionName=all Nodes=ALL Default=YES State=UP"
    } >"$folder/slurm.conf"
    export SLURM_CONF="$folder/slurm.conf"
    slurmctld -c -f "$SLURM_CONF"
    for node in $(seq "$nodes"); do
        mkdir -p "$folder/box$node"
        slurmd -c -N "box$node" -f "$SLURM_CONF"
    done
    for _ in $(seq 300); do
        idle=$(sinfo --noheader --Node --format=%T 2>/dev/null | grep -c '^idle$' || true)
        if [ "$idle" = "$nodes" ]; then
            echo "export SLURM_CONF=$SLURM_CONF"
            return
        fi
        sleep 0.1
    done
    echo "the nodes did not come up within 30 s; see $folder/*.log" >&2
    tail -n 20 "$folder"/*.log >&2 || true
    stop
    exit 1
}

case $action in
    start) start ;;
    stop) stop ;;
    *) usage ;;
esac
