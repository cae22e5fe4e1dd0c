#!/bin/sh
# Measures the tables of the control pages and writes them to control.md beside this file, some minutes.
#
#   cargo build --release -p handstand && docs/measured/control.sh
#
# HANDSTAND names another program, ROBOTS and REGION the robots of a trial and of a step of the search for regions.
# Same version, seed and numbers, same tables on any machine.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
models=$here/../../host/models
program=${HANDSTAND:-$here/../../target/release/handstand}
page=$here/control.md
trap 'rm -f "$page.new"' EXIT INT TERM
robots=${ROBOTS:-1000} region=${REGION:-100}
version=$("$program" --version | cut -d ' ' -f 2)
commit=$(git -C "$here" describe --always --dirty 2>/dev/null || echo "no commit")

# What tuning says of a model; nothing of one that has no drive.
tune() {
    said=$(cd "$models" && "$program" gains "$1" --tune 2>&1 >/dev/null) || true
    said=$(printf '%s\n' "$said" | sed -n 's/^tuned, of [0-9]* weights: //p')
    if [ -n "$said" ]; then printf '| `%s` | %s |\n' "$1" "$said"; fi
}

# The command as typed in host/models, its table, and its exit code.
measure() {
    printf '\n```console\n$ handstand %s\n' "$*"
    code=0
    (cd "$models" && "$program" --quiet "$@") || code=$?
    printf '(exit code %s)\n```\n' "$code"
}

{
    printf '# Control: measured\n\nMeasured on %s with version %s (%s) by\n\n```sh\n%s\n```\n\n' \
        "$(date -u +%Y-%m-%d)" "$version" "$commit" "ROBOTS=$robots REGION=$region docs/measured/control.sh"
    printf 'which wrote this page. Do not edit it: run it again. Simulations, seed 1.\n'
    printf '\n## Verification of gains\n'
    measure gains handstand.toml
    measure gains robot.toml
    printf '\n## Weights\n\n`handstand gains MODEL --tune` of every model with a drive. Where friction holds the arm upright\n'
    printf 'without any command, the region is its, too.\n\n| Model | Chosen, and plain weights |\n|---|---|\n'
    for model in $(cd "$models" && ls ./*.toml); do
        tune "${model#./}"
    done
    printf '\n## Word length\n\nWith 8 and 9 bits no place is left behind the point: the same rounded gains, slow and coarse. With\n'
    printf '10 bits rounding happens to move a pole out, to 1.009: whether so few bits stabilise is chance. From\n'
    printf '11 bits on each bit more costs less, down to floating point.\n'
    measure study sweep float-fixed word-length
    printf '\n## Wrong masses\n'
    measure robust handstand.toml
    measure robust handstand.toml --with-inertia
    printf '\n## Sweeps\n'
    measure study sweep dead-zone delay
    measure study sweep delay --controller best
    printf '\n## Controllers\n'
    measure controllers handstand.toml --robots "$robots" --region-robots "$region"
    printf '\n## Delays\n'
    measure delays handstand.toml
} >"$page.new"
mv "$page.new" "$page"
