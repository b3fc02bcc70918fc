# Set-up shared by ./quickstart and ./run-tests; sourced by bash, from the repository's root.
# Safe to repeat: what is there already is found in a second and left alone.

export LC_ALL=C.UTF-8 LANG=C.UTF-8
# Another checkout of the same sources may use what the compiler cache holds.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_COMPILERCHECK=content

readonly log_directory=build/logs
mkdir -p "$log_directory"

# "LABEL: N s" of each step that run_with_progress has finished.
steps_taken=()

say() { printf '%s\n' "$*"; }

fail() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# What run_with_progress shows while a command runs: with a terminal one line that is rewritten,
# without one a line every 15 seconds.
show_progress() {
  local label=$1 log=$2 start=$SECONDS shown=$SECONDS line width
  while kill -0 $$ 2>/dev/null; do # ends with the script, however that ends
    sleep 0.3
    [ -t 1 ] || ((SECONDS - shown >= 15)) || continue
    shown=$SECONDS
    line=$(tail -c 2000 "$log" 2>/dev/null | tr '\r' '\n' | tr -cd '[:print:]\n' |
      sed '/^ *$/d' | tail -n 1)
    line="$label: $((SECONDS - start)) s  $line"
    if [ -t 1 ]; then
      width=$(($(tput cols 2>/dev/null || echo 80) - 1))
      printf '\r\033[K%s' "${line:0:width}"
    else
      printf '%s\n' "${line:0:120}"
    fi
  done
}

# run_with_progress LABEL LOG COMMAND...: runs the command with its output in LOG. If it fails, the
# end of the log is shown and its exit code returned. (`set -e` does not reach into a function whose
# failure the caller handles, so COMMAND must chain its own steps.)
run_with_progress() {
  local label=$1 log=$log_directory/$2 start=$SECONDS watcher code=0
  shift 2
  : >"$log"
  show_progress "$label" "$log" &
  watcher=$!
  ("$@") >"$log" 2>&1 </dev/null || code=$?
  kill "$watcher" 2>/dev/null || true
  wait "$watcher" 2>/dev/null || true
  if [ -t 1 ]; then printf '\r\033[K'; fi
  if ((code != 0)); then
    tail -n 60 "$log"
    say "$label: failed after $((SECONDS - start)) s (all of its output: $log)"
    return "$code"
  fi
  say "$label: done in $((SECONDS - start)) s"
  steps_taken+=("$label: $((SECONDS - start)) s")
}

# Whether as_root would work. A password is asked for here, where somebody can see the question.
can_be_root() {
  if [ "$(id -u)" -eq 0 ]; then return; fi
  command -v sudo >/dev/null || return
  sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo "$@"
  fi
}

# missing_packages KIND GROUP...: packages of these groups that are not installed, one per line.
# KIND is needed, or optional (a question mark behind the group's name).
missing_packages() {
  local kind=$1 mark= package wanted
  shift
  if [ "$kind" = optional ]; then mark='?'; fi
  wanted=$(for group in "$@"; do
    awk -v group="$group$mark" '$1 == group { print $2 }' setup/debian-packages.txt
  done)
  for package in $wanted; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      printf '%s\n' "$package"
  done
}

# Whether apt has a version of the package to install.
is_available() { [[ $(apt-cache policy "$1" 2>/dev/null) =~ Candidate:\ [^\(] ]]; }

# An apt-get or dpkg that was interrupted, perhaps in an earlier run of this script, leaves packages
# half installed and refuses all work until this is called.
finish_interrupted_install() { as_root env DEBIAN_FRONTEND=noninteractive dpkg --configure -a; }

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 -o Acquire::Retries=3 "$@"
}

# install_packages GROUP...
install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "packages: not a Debian system, so nothing is installed; docs/building.md lists what is needed"
    return
  fi
  local missing optional package
  missing=$(missing_packages needed "$@")
  optional=$(missing_packages optional "$@")
  if [ -z "$missing$optional" ]; then
    say "packages: all installed"
    return
  fi
  if ! can_be_root; then
    if [ -n "$missing" ]; then
      fail "these packages are missing, and only root or sudo can install them:" \
        "apt-get install --no-install-recommends" $missing $optional
    fi
    say "packages: all installed, but for optional ones:" $optional
    return
  fi
  run_with_progress "package index" apt-update.log apt_get update ||
    fail "apt-get update failed"
  for package in $optional; do
    if is_available "$package"; then
      missing+=" $package"
    else
      say "packages: this system offers no $package, so we do without"
    fi
  done
  if [ -z "$missing" ]; then return; fi
  say "packages: installing" $missing
  if [ -n "$(dpkg --audit)" ]; then
    run_with_progress "packages: finish what was interrupted" dpkg-configure.log \
      finish_interrupted_install || fail "dpkg --configure -a failed"
  fi
  # shellcheck disable=SC2086
  run_with_progress "packages" apt-install.log \
    apt_get install -y --no-install-recommends $missing || fail "apt-get install failed"
}

download_demo() {
  # Root's apt-get would hand the download to a user who may not write here, and warn.
  apt-get -q -o APT::Sandbox::User=root -o Acquire::Retries=3 download libcgal-demo
}

unpack_meshes() {
  local archive
  cd "$1" || return
  if ! download_demo; then
    echo "the package index may be missing or old: updating it"
    can_be_root && apt_get update && download_demo || return
  fi
  dpkg-deb -x libcgal-demo_*.deb unpacked && mkdir meshes || return
  archive=$(find unpacked -name 'data.tar.gz' | head -n 1)
  tar -xzf "$archive" -C meshes --strip-components=2 --wildcards 'data/meshes/*.off'
}

# Sets and exports GRASPFIT_PACKAGED_MESHES: the folder with the meshes of Debian's libcgal-demo.
# They are unpacked beside it and renamed, so that an interrupted run leaves nothing half done.
fetch_meshes() {
  if [ -n "${GRASPFIT_PACKAGED_MESHES:-}" ]; then
    [ -f "$GRASPFIT_PACKAGED_MESHES/bunny00.off" ] ||
      fail "GRASPFIT_PACKAGED_MESHES=$GRASPFIT_PACKAGED_MESHES: no bunny00.off there"
    say "meshes: $GRASPFIT_PACKAGED_MESHES"
    return
  fi
  local cache=${XDG_CACHE_HOME:-${HOME:+$HOME/.cache}} work
  cache+=${cache:+/graspfit}
  if [ -z "$cache" ] || ! mkdir -p "$cache" 2>/dev/null || ! [ -w "$cache" ]; then
    cache=$PWD/build/cache
    mkdir -p "$cache"
    export CCACHE_DIR=${CCACHE_DIR:-$cache/ccache}
  fi
  export GRASPFIT_PACKAGED_MESHES=$cache/meshes
  if [ -f "$cache/meshes/bunny00.off" ] && [ -f "$cache/meshes/armadillo.off" ]; then
    say "meshes: $cache/meshes"
    return
  fi
  command -v apt-get >/dev/null ||
    fail "no apt-get: unpack the meshes of CGAL's data folder and set GRASPFIT_PACKAGED_MESHES"
  work=$(mktemp -d "$cache/unpacking.XXXXXX")
  # shellcheck disable=SC2064
  trap "rm -rf '$work'" EXIT
  run_with_progress "meshes of libcgal-demo" meshes.log unpack_meshes "$work" ||
    fail "libcgal-demo could not be downloaded (apt-get update, as root, may help);" \
      "GRASPFIT_PACKAGED_MESHES can name a folder with the meshes of its data.tar.gz"
  [ -f "$work/meshes/bunny00.off" ] || fail "libcgal-demo holds no bunny00.off"
  rm -rf "$cache/meshes"
  mv -T "$work/meshes" "$cache/meshes"
  rm -rf "$work"
  trap - EXIT
}

# How many compilers at once: one per processor, but 1.5 GB for each (CGAL's headers are large).
build_jobs() {
  local processors memory_kb jobs
  processors=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || echo 4000000)
  jobs=$((memory_kb / 1500000))
  ((jobs < 1)) && jobs=1
  ((jobs > processors)) && jobs=$processors
  echo "${GRASPFIT_JOBS:-$jobs}"
}

# configure PRESET [CMAKE OPTION...]: with CI set, warnings are errors.
configure() {
  local preset=$1 warnings_as_errors=OFF
  if [ -n "${CI:-}" ]; then warnings_as_errors=ON; fi
  run_with_progress "configure" "configure-$preset.log" cmake --preset "$@" \
    -DGRASPFIT_WARNINGS_AS_ERRORS=$warnings_as_errors || fail "cmake --preset $preset failed"
}

# build PRESET TARGET...
build() {
  local preset=$1
  shift
  export NINJA_STATUS='[%f/%t] '
  run_with_progress "build" "build-$preset.log" \
    cmake --build --preset "$preset" --parallel "$(build_jobs)" --target "$@" ||
    fail "the build failed"
}
