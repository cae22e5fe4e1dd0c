#!/bin/sh
# Every log of a folder diagnosed by itself, in N shards by GNU parallel, then put together.
#
#   each.sh MODEL.toml LOGS RESULT N [parallel's own options, such as --sshlogin a,b]
#
# Interrupted, the same line goes on where it was. On other machines the folders must be the same shared ones.
set -eu
if [ $# -lt 4 ]; then
    echo "usage: $0 MODEL.toml LOGS RESULT N [options of parallel]" >&2
    exit 2
fi
model=$1 logs=$2 result=$3 shards=$4
shift 4
program=${HANDSTAND:-handstand}
# shellcheck disable=SC1083 # the braces are parallel's
seq "$shards" | parallel --halt soon,fail=1 "$@" \
    "RAYON_NUM_THREADS=1 '$program' --quiet diagnose '$model' --each '$logs' -o '$result' --shard {}/$shards"
exec "$program" diagnose "$model" --each "$logs" -o "$result"
