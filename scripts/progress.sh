# scripts/setup.sh sources this file, which shows the progress of each step. In a terminal, it
# updates one line for each step. In a log, it adds a line every $progress_log_every seconds. The
# output of the tools goes to $progress_log. If a step fails, it shows the end of that file.
# shellcheck shell=bash

progress_log=$PWD/build/setup.log
progress_log_every=30  # seconds between two lines of a log
progress_steps=0 progress_step=0 progress_name='' progress_begun=0 progress_shown=''
if [ -t 2 ] && [ "${TERM:-dumb}" != dumb ]; then progress_terminal=1; else progress_terminal=; fi

# duration SECONDS: prints a duration such as "40 s" or "3 min".
duration() {
  if [ "$1" -lt 90 ]; then echo "$1 s"; else echo "$((($1 + 30) / 60)) min"; fi
}

# number_steps COUNT: starts to number the next COUNT steps.
number_steps() { progress_steps=$1 progress_step=0; }

progress_line() {
  if [ "$progress_steps" -gt 0 ]; then printf '[%d/%d] ' "$progress_step" "$progress_steps"; fi
  printf '%s: %s' "$progress_name" "$1"
}

begin_step() {  # NAME
  progress_name=$1 progress_begun=$SECONDS progress_shown=''
  progress_step=$((progress_step + 1))
  mkdir -p "$(dirname "$progress_log")"
  printf '\n== %s, %s\n' "$progress_name" "$(date '+%F %T')" >>"$progress_log"
}

# show_progress TEXT: shows TEXT, one line of at most 60 characters.
show_progress() {
  if [ -n "$progress_terminal" ]; then
    printf '\r\033[K%s' "$(progress_line "$1")" >&2
  elif [ -z "$progress_shown" ] || [ $((SECONDS - progress_shown)) -ge "$progress_log_every" ]; then
    printf '%s\n' "$(progress_line "$1")" >&2
    progress_shown=$SECONDS
  fi
}

end_step() {
  [ -z "$progress_terminal" ] || printf '\r\033[K' >&2
  printf '%s\n' "$(progress_line "done in $(duration $((SECONDS - progress_begun)))")" >&2
}

fail_step() {  # WHAT
  [ -z "$progress_terminal" ] || printf '\r\033[K' >&2
  # Print from the first error if the tool marks errors (Ninja), otherwise the last lines.
  awk '/^== /      { lines = 0; failed = 0 }
       /^FAILED: / { if (!failed) { lines = 0; failed = 1 } }
                   { kept[lines++] = $0 }
       END         { begin = failed || lines < 40 ? 0 : lines - 40
                     end = lines < begin + 40 ? lines : begin + 40
                     for (i = begin; i < end; ++i) print kept[i] }' "$progress_log" >&2
  die "$1 The lines above show the reason. $progress_log contains all lines."
}

# in_step TEXT COMMAND…: runs a part of a step that does not report its progress.
in_step() {
  show_progress "$1"
  shift
  "$@" >>"$progress_log" 2>&1
}

# Shows the progress that apt-get writes to APT::Status-Fd. Other lines go to the log.
show_apt_progress() {
  local line kind percent
  while IFS= read -r line; do
    IFS=: read -r kind _ percent _ <<<"$line"
    case $kind in
      dlstatus) show_progress "downloading, ${percent%%.*} %" ;;
      pmstatus) show_progress "installing, ${percent%%.*} %" ;;
      *) printf '%s\n' "$line" >>"$progress_log" ;;
    esac
  done
}

# unit_weight LINE: prints the weight of a unit. A unit of several files takes the compiler about
# fourteen times as long as a unit of one file.
unit_weight() { case $1 in *Unity/*) echo 14 ;; *) echo 1 ;; esac; }

# weigh_units: prints the total weight of the lines of `ninja -n` on standard input.
weigh_units() {
  local line sum=0
  while IFS= read -r line; do
    [[ $line != \[* ]] || sum=$((sum + $(unit_weight "$line")))
  done
  echo $sum
}

# show_ninja_progress WEIGHT MILLISECONDS: reads Ninja's output with NINJA_STATUS='[%f/%t] '. WEIGHT
# is the total weight of all units. MILLISECONDS is the usual time for a weight of 1 on this
# machine. In the estimate of the remaining time, this usual time has the same weight as the
# measured time of a fifth of the units.
show_ninja_progress() {
  local weight=$1 unit_ms=$2 line partial='' finished=0 total=0 done_weight=0 begun=$SECONDS known left code
  while true; do
    code=0
    IFS= read -r -t 1 line || code=$?
    if [ $code -gt 128 ]; then
      partial+=$line  # one second without a complete line; the rest follows
    else
      [ $code = 0 ] || [ -n "$partial$line" ] || break
      line=$partial$line partial=''
      printf '%s\n' "$line" >>"$progress_log"
      if [[ $line =~ ^\[([0-9]+)/([0-9]+)\]\  ]]; then
        finished=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
        done_weight=$((done_weight + $(unit_weight "$line")))
        [ "$done_weight" -le "$weight" ] || weight=$done_weight
      fi
    fi
    [ "$total" -gt 0 ] || continue
    known=$((weight / 5 + 1))
    left=$(((known * unit_ms / 1000 + SECONDS - begun) * (weight - done_weight) / (known + done_weight)))
    show_progress "$finished of $total units, $((100 * done_weight / weight)) %, about $(duration $(((left + 9) / 10 * 10))) left"
  done
}
