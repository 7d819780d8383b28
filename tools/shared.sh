# What tools/setup, tools/demo and tools/test have in common; they read it with `.`.
tool=tools/$(basename "$0")

say() { echo "$tool: $*"; }
fail() { # fail CODE TEXT
  echo "$tool: $2" >&2
  exit "$1"
}

# The comment at the head of the script, which is its help.
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

# follow LOG: copies its input to LOG and shows where it stands, on a terminal by a line that the
# next one overwrites, else by a line every 10 seconds, also when nothing comes.
follow() {
  local line='' part status=0 said=$SECONDS shown
  : >"$1"
  while [ $status -eq 0 ] || [ $status -gt 128 ]; do # above 128: nothing came for so long
    status=0
    IFS= read -r -t 10 part || status=$?
    line+=$part
    shown=$line
    if [ $status -gt 128 ]; then
      shown="... $SECONDS s"
    elif [ $status -eq 0 ] || [ -n "$line" ]; then
      printf '%s\n' "$line" >>"$1"
      line=''
    fi
    if [ -t 1 ]; then
      shown=${shown##*$'\r'} # what it would overwrite itself
      printf '\r\033[K%s' "${shown:0:79}"
    elif [ $((SECONDS - said)) -ge 10 ] && [ -n "$shown" ]; then
      said=$SECONDS
      printf '%s\n' "$shown"
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
  if nvidia-smi -L 2>/dev/null | grep -q '^GPU '; then gpu=yes; fi
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

# build TARGETS...: on a terminal Ninja's own line of progress; the compiler's words stay.
build() {
  say "building $* in build/"
  if [ -t 1 ]; then
    cmake --build build --target "$@" || fail 1 "the build failed, see above"
  else
    quietly build/build.log cmake --build build --target "$@"
  fi
}
