#!/bin/bash
# A sequence by several processes: gnu_parallel.sh SCENE OUTPUT FRAMES [OPTION OF RENDER...]
# TASKS: how many (8); PARALLEL: options of parallel, such as "--sshlogin machine1,machine2 --workdir ." or "--jobs 2".
# Each task is tried three times, whatever its exit code.
set -euo pipefail
[ $# -ge 3 ] || { echo "usage: gnu_parallel.sh SCENE OUTPUT FRAMES [OPTION OF RENDER...]" >&2; exit 2; }
tasks=${TASKS:-8}
seq "$tasks" | parallel --quote -N0 --retries 3 --halt soon,fail=1 --line-buffer \
    "${KILOLUX:-kilolux}" render "$1" -o "$2" --frames "$3" --shard "auto/$tasks" --skip-existing --progress plain "${@:4}"
