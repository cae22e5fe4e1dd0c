#!/bin/sh
# A Monte Carlo study in N shards by GNU parallel, then merged.
#
#   parallel.sh STUDY.toml FOLDER N [parallel's own options, such as --sshlogin a,b]
#
# Interrupted, the same line goes on where it was. On other machines FOLDER must be the same shared folder.
set -eu
if [ $# -lt 3 ]; then
    echo "usage: $0 STUDY.toml FOLDER N [options of parallel]" >&2
    exit 2
fi
study=$1 folder=$2 shards=$3
shift 3
program=${HANDSTAND:-handstand}
# shellcheck disable=SC1083 # the braces are parallel's
seq "$shards" | parallel --halt soon,fail=1 "$@" \
    "RAYON_NUM_THREADS=1 '$program' --quiet study monte-carlo '$study' -o '$folder' --shard {}/$shards"
exec "$program" study merge "$folder" -o "$folder"
