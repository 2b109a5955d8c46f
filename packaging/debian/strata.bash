# Completion of strata(1): offers the commands and options that --help lists.
_strata() {
  local current=${COMP_WORDS[COMP_CWORD]} command=() word help
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == -* ]] || command+=("$word")
  done
  # Only the command and its subcommand are commands; later words are arguments.
  help=$(strata "${command[@]:0:2}" --help 2>/dev/null || strata "${command[@]:0:1}" --help 2>/dev/null)
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '--[a-z][a-z-]*' <<<"$help")" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -W "$(awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 }' <<<"$help")" -- "$current")
    [ ${#COMPREPLY[@]} -gt 0 ] || mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -o filenames -F _strata strata
