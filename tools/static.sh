# What tools/bundle and tools/wheel have in common, a program that needs nothing but glibc; they
# read it with `.`.
. "$(dirname "${BASH_SOURCE[0]}")/shared.sh"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# SASS for the data-centre and desktop GPUs from Turing on, PTX of the newest for what comes later.
arch='75-real;80-real;86-real;89-real;90-real;100-real;120-virtual'
cuda=AUTO
build=$root/build-bundle
jobs=$(nproc)
glibc=2.36 # of Debian 12, the oldest system that the project builds on
allowed='libc.so.6 libm.so.6 libdl.so.2 libpthread.so.0 librt.so.1 ld-linux-x86-64.so.2'

static_usage='[--cuda | --no-cuda] [--arch LIST] [--build DIR] [--jobs N]'
static_options="  --cuda       with the CUDA backend, or an error where no CUDA toolkit is found
  --no-cuda    CPU only; without either it is CPU + CUDA where a toolkit is found
  --arch LIST  CUDA architectures as CMake takes them: NN-real machine code, NN-virtual PTX, NN both
               (default $arch)
  --build DIR  build folder (default build-bundle); kept, so that the next one is quick
  --jobs N     parallel jobs (default $jobs)"

# static_option ARGUMENTS...: takes the first, with its value; `taken` says how many words it was.
# False when it is none of these.
static_option() {
  taken=1
  case $1 in
    --help | -h) usage; exit 0 ;;
    --cuda) cuda=ON; return ;;
    --no-cuda) cuda=OFF; return ;;
    --arch | --build | --jobs) ;;
    *) return 1 ;;
  esac
  [ $# -ge 2 ] && [ -n "$2" ] || fail 2 "$1 needs a value"
  taken=2
  case $1 in
    --arch) arch=$2 ;;
    --build) build=$(realpath -m "$2") ;;
    --jobs) jobs=$2 ;;
  esac
}

# need TOOL...: what is called here is there.
need() {
  local name
  for name; do
    command -v "$name" >/dev/null || fail 4 "$name not found: install it (tools/setup does)"
  done
}

need_for_static() {
  need cmake ninja g++ strip readelf objdump
  [ "$(uname -sm)" = 'Linux x86_64' ] ||
    fail 4 "this is made on Linux x86_64, not on $(uname -sm)"
}

# build_static TARGETS...: in the folder $build.
build_static() {
  local launcher=()
  # The caller's flags stay out, since -march=native would tie it to this machine's CPU.
  unset CFLAGS CXXFLAGS CUDAFLAGS LDFLAGS CUDAARCHS NVCC_PREPEND_FLAGS NVCC_APPEND_FLAGS
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
  fi
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPBF_STATIC=ON \
    -DPBF_RENDER=ON -DPBF_TESTS=ON -DPBF_CUDA=$cuda -DCMAKE_CUDA_ARCHITECTURES="$arch" \
    "${launcher[@]}" || fail 1 "configuring failed; the message of CMake is above"
  nice ninja -C "$build" -j "$jobs" "$@" || fail 1 "building failed; the messages are above"
}

cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

# What a program of glibc's the file asks for at most, e.g. 2.34.
newest_glibc() {
  objdump -T "$1" | grep -o 'GLIBC_[0-9.]*' | sort -Vu | tail -n 1 | sed 's/GLIBC_//'
}

# why_not_portable PROGRAM: why it does not run wherever glibc is as new as $glibc; nothing if it
# does.
why_not_portable() {
  local library newest
  for library in $(readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
    case " $allowed " in
      *" $library "*) ;;
      *)
        echo "it needs $library at run time"
        return
        ;;
    esac
  done
  if readelf -d "$1" | grep -qE '\((RPATH|RUNPATH)\)'; then
    echo "it looks for libraries in a folder of this machine (readelf -d, RPATH or RUNPATH)"
    return
  fi
  newest=$(newest_glibc "$1")
  if [ "$(printf '%s\n' $glibc "$newest" | sort -V | tail -n 1)" != $glibc ]; then
    echo "it needs glibc $newest, newer than $glibc ($(objdump -T "$1" |
      grep -F "GLIBC_$newest" | awk '{print $NF}' | head -n 5 | xargs))"
  fi
}

# check_static PROGRAM...: each is portable.
check_static() {
  local program why
  for program; do
    why=$(why_not_portable "$program")
    [ -z "$why" ] ||
      fail 1 "$program: $why; .cmake/static.cmake says what is linked in, Debian 12 has glibc $glibc"
    say "$program: $(stat -c %s "$program") bytes, needs glibc $(newest_glibc "$program")"
  done
}

# cuda_toolkit PROGRAM: the CUDA version of the program, e.g. 13.0; nothing without the backend.
cuda_toolkit() { "$(realpath "$1")" info | sed -n 's/^cudart *//p'; }

# copy_licenses FOLDER TOOLKIT PACKAGE...: the licences of what is linked into pbf, of CUDA's runtime
# where TOOLKIT is a version, and of more packages.
copy_licenses() {
  local package folder=$1 toolkit=$2
  shift 2
  for package in libhdf5-dev libaec-dev zlib1g-dev libyaml-cpp-dev libfmt-dev libpng-dev \
    libstb-dev libcli11-dev nlohmann-json3-dev "gcc-$(g++ -dumpversion)-base" "$@"; do
    [ -e /usr/share/doc/$package/copyright ] ||
      fail 1 "no /usr/share/doc/$package/copyright: what is linked in must come with its licence"
    cp -L /usr/share/doc/$package/copyright "$folder/$package.txt"
  done
  cp "$root/lib/render/font/LICENSE" "$folder/dejavu-fonts.txt"
  if [ -n "$toolkit" ]; then
    echo "pbf holds NVIDIA's CUDA runtime $toolkit (cudart_static), which the End User License Agreement
of the CUDA toolkit lets programs carry." >"$folder/cuda-runtime.txt"
  fi
}
