# SPDX-License-Identifier: Apache-2.0
# What scripts/demo, scripts/test and scripts/bundle share; they source it. Debian 12 and Ubuntu 24.04.
# Leaves the shell in the repository's root.

unset CDPATH
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages_to_build=(
  cmake ninja-build g++ pkg-config
  libtbb-dev libhwy-dev                                                  # sim
  nlohmann-json3-dev libcgal-dev libeigen3-dev libpugixml-dev zlib1g-dev # robots
  libepoxy-dev libegl-dev libgl-dev libglfw3-dev libpng-dev libstb-dev fonts-lato fonts-font-awesome   # render
  libmuparser-dev                                                        # evolution
  libcli11-dev libfmt-dev libhdf5-dev libimgui-dev libtomlplusplus-dev   # app
)
packages_to_run=(ffmpeg libegl1 libegl-mesa0 libgl1-mesa-dri)
packages_welcome=(libosmesa6 libopenmpi-dev openmpi-bin)  # drawing where EGL is missing (newer distributions no longer have OSMesa); evolution on several hosts
packages_to_test=(clang-format-14 libgtest-dev libgmock-dev libbenchmark-dev xvfb xdotool python3-h5py python3-numpy python3-pil python3-matplotlib)
packages_for_python=(python3-venv python3-dev)   # what they need besides is in python/tests/requirements.txt
packages_welcome_to_test=(python3-torch)         # tests that need PyTorch skip without it

fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# logged FILE COMMAND...: writes the command's output to build/FILE, and prints its end if the command fails.
logged() {
  local log=build/$1
  shift
  if ! "$@" </dev/null >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    fail "this command failed: $* (all of its output: $log)"
  fi
}

# install_missing PACKAGE...: installs by apt what dpkg does not list as installed. If nothing is missing, it prints
# nothing and does not use the network.
install_missing() {
  command -v dpkg-query >/dev/null ||
    fail "this machine has no dpkg; install what scripts/setup.sh lists under its own names, then use cmake (docs/building.md)"
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; } ||
      fail "packages are missing; as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}" >&2
  mkdir -p build
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
  logged apt-update.log "${apt[@]}" update
  for package in "${packages_welcome[@]}"; do
    if apt-get -s install "$package" >/dev/null 2>&1; then missing+=("$package"); fi
  done
  logged apt-install.log "${apt[@]}" install --no-install-recommends "${missing[@]}"
}

# One compiler per core, but not more than fit into memory: with CGAL each takes up to 2 GB.
build_jobs() {
  local cores gigabytes
  cores=$(nproc)
  gigabytes=$(awk '/^MemAvailable/ { print int($2 / 2e6) }' /proc/meminfo)
  ((gigabytes < 1)) && gigabytes=1
  echo $((cores < gigabytes ? cores : gigabytes))
}

# configure CMAKE-OPTION...: configures build/ for this machine, or adds the options to a build/ that exists.
configure() {
  mkdir -p build
  if [[ -e build/CMakeCache.txt ]]; then
    logged configure.log cmake -B build "$@"
  else
    logged configure.log cmake --preset default -DCMAKE_CUDA_ARCHITECTURES="$(cuda_architectures)" "$@"
  fi
}

# python_environment: makes build/venv, a virtual environment of the distribution's Python with what builds and tests the
# Python package. It has the distribution's packages, too. If it is up to date, nothing is printed, and the network is
# not used. Returns 1 if the packages cannot be had.
python_environment() {
  local venv=build/venv requirements=python/tests/requirements.txt
  if cmp -s "$requirements" "$venv/requirements.txt" && "$venv/bin/python" -c "import nanobind" 2>/dev/null; then return; fi
  echo "Installing Python packages into $venv" >&2
  mkdir -p build
  rm -rf "$venv"
  {
    /usr/bin/python3 -m venv --system-site-packages "$venv" &&
      "$venv/bin/python" -m pip install --disable-pip-version-check --retries 1 -r "$requirements" &&
      cp "$requirements" "$venv/requirements.txt"
  } </dev/null >build/venv.log 2>&1
}

# This machine's GPU, or Hopper where there is none: every further architecture is another compilation.
cuda_architectures() {
  if command -v nvidia-smi >/dev/null && nvidia-smi -L >/dev/null 2>&1; then echo native; else echo 90; fi
}

# build_targets TARGET...: builds them in build/. Prints a line only if a source has changed since the last time.
build_targets() {
  local built="build/built-$*"
  if [[ ! -e $built || -n $(find CMakeLists.txt CMakePresets.json cmake sim robots evolution render app shaders python bench \
                              tests examples -newer "$built" -type f ! -name '*.pyc' -print -quit) ]]; then
    echo "Building; all of its output: build/build.log" >&2
    sed -n 's/^-- Mercury: //p' build/configure.log >&2
  fi
  logged build.log cmake --build build --parallel "$(build_jobs)" --target "$@"
  touch "$built"
}
