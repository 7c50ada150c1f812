#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Runs the first command on the rank RANK of MPI, and the second one on all others. mpiexec itself
# has ":" for that, at which Open MPI 5.0.7 of Debian 13 crashes.
#
#   mpiexec -n RANKS sh on_rank.sh RANK COMMAND [ARGUMENT...] @ COMMAND [ARGUMENT...]
here="${OMPI_COMM_WORLD_RANK:-${PMI_RANK:?no rank of MPI}}"
kept=0
[ "$here" = "$1" ] && kept=1
shift
left=$#
while [ "$left" -gt 0 ]; do
  word="$1"
  shift
  if [ "$word" = @ ]; then
    kept=$((1 - kept))
  elif [ "$kept" = 1 ]; then
    set -- "$@" "$word"
  fi
  left=$((left - 1))
done
exec "$@"
