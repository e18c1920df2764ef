#!/bin/sh
# lose_a_process.sh RANK FILE MPIRUN...: runs a command that starts processes as mpirun does, its children in the order
# of their ranks, kills the one of this rank once a file of this pattern is there with something in it, and ends as the
# command does.
rank=$1 file=$2
shift 2
"$@" &
run=$!
tries=0
# shellcheck disable=SC2086 # a pattern
until [ -s "$(ls $file 2>/dev/null | head -n 1)" ]; do
  tries=$((tries + 1))
  if [ "$tries" -gt 600 ] || ! kill -0 "$run" 2>/dev/null; then
    echo "lose_a_process.sh: there has been no $file" >&2
    kill "$run" 2>/dev/null
    wait "$run"
    exit 0
  fi
  sleep 0.1
done
kill -9 "$(ps -o pid= --ppid "$run" | sort -n | sed -n "$((rank + 1))p")"
wait "$run"
