#!/bin/bash
#SBATCH --job-name=kilolux
#SBATCH --array=0-7
#SBATCH --requeue
#SBATCH --signal=B:TERM@30
# An array of tasks that make a sequence: sbatch slurm_array.sh SCENE OUTPUT FRAMES [OPTION OF RENDER...]
# A task whose machine is lost runs again elsewhere, and makes what is not there. One that reaches its time limit ends
# between pictures, with exit code 143.
[ $# -ge 3 ] || { echo "usage: slurm_array.sh SCENE OUTPUT FRAMES [OPTION OF RENDER...]" >&2; exit 2; }
exec "${KILOLUX:-kilolux}" render "$1" -o "$2" --frames "$3" --shard auto --skip-existing --progress plain "${@:4}"
