# What tools/setup, tools/demo and tools/test have in common; they read it with `.`.
tool=tools/$(basename "$0")

say() { echo "$tool: $*"; }
fail() { # fail CODE TEXT
  echo "$tool: $2" >&2
  exit "$1"
}

# The comment at the head of the script, which is its help.
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

# follow LOG [kept]: copies its input to LOG and shows where it stands and since how many seconds: on
# a terminal in a line that is overwritten every second, else in a line every $every seconds, whether
# something comes or not. `kept`: of a build, whose steps begin with [n/N]; other lines, which are the
# compiler's, stay on a terminal.
every=10
follow() {
  local line='' part status=0 begun=$SECONDS said=$SECONDS where='' keep=${2:-}
  : >"$1"
  while [ $status -eq 0 ] || [ $status -gt 128 ]; do # above 128: nothing came for so long
    status=0
    IFS= read -r -t 1 part || status=$?
    line+=$part
    if [ $status -le 128 ] && { [ $status -eq 0 ] || [ -n "$line" ]; }; then
      printf '%s\n' "$line" >>"$1"
      if [ -t 1 ] && [ -n "$keep" ] && [[ $line != \[+([0-9])/+([0-9])\]* ]]; then
        printf '\r\033[K%s\n' "$line"
      elif [ -n "$line" ]; then
        where=${line##*$'\r'} # what it would overwrite itself
      fi
      line=''
    fi
    if [ -t 1 ]; then
      part="$((SECONDS - begun)) s  $where"
      printf '\r\033[K%s' "${part:0:79}"
    elif [ $((SECONDS - said)) -ge $every ]; then
      said=$SECONDS
      printf '%s s  %s\n' $((SECONDS - begun)) "${where:-...}"
    fi
  done
  if [ -t 1 ]; then printf '\r\033[K'; fi
}

# quietly LOG COMMAND...: its output only by `follow`; all of it, and the end, when it fails.
quietly() {
  local log=$1
  shift
  "$@" 2>&1 | follow "$log" || {
    cat "$log" >&2
    fail 1 "\`$1\` failed, see above; the text is also in $log"
  }
}

# configure CUDA CMAKE_ARGUMENTS...: makes build/ ready, or keeps it as it was made. CUDA: ON, OFF,
# or AUTO for the CUDA backend where the driver lists a GPU and a toolkit is found.
configure() {
  local cuda=$1 gpu=no why args=(-S . -B build)
  shift
  if [ ! -e build/CMakeCache.txt ]; then args+=(-G Ninja -DCMAKE_BUILD_TYPE=Release); fi
  # No pipe: grep -q stops at the first of several GPUs, and the broken pipe counts as a failure.
  if [[ $(nvidia-smi -L 2>/dev/null) == *"GPU "* ]]; then gpu=yes; fi
  case $cuda$gpu in
    OFF*) why='as was asked' ;;
    AUTOno) cuda=OFF why='nvidia-smi lists no GPU; --cuda builds it all the same' ;;
    *yes) why='there is a GPU, but no CUDA toolkit' args+=(-DCMAKE_CUDA_ARCHITECTURES=native) ;;
  esac
  say "configuring build/"
  mkdir -p build
  quietly build/configure.log cmake "${args[@]}" -DPBF_CUDA="$cuda" "$@"
  if grep -q '^-- CUDA backend: on' build/configure.log; then
    say "with the CUDA backend"
  else
    say "without the CUDA backend (${why:-see build/configure.log})"
  fi
}

# build TARGETS...: on a terminal the compiler's words stay, else they come when it fails.
build() {
  local log=build/build.log
  say "building $* in build/"
  if [ -t 1 ]; then
    cmake --build build --target "$@" 2>&1 | follow "$log" kept ||
      fail 1 "the build failed, see above; the text is also in $log"
  else
    quietly "$log" cmake --build build --target "$@"
  fi
}
