# shellcheck shell=sh disable=SC2034
# Debian packages that rheo needs, and how to get them; sourced by app/demo.sh and tests/run.sh.

# To build: compiler and tools, algebra, scene files, text, command line, JSON, the pictures' text, PNG, the headers
# of GLFW, OpenGL and EGL and the font that is embedded.
build_packages="g++ cmake ninja-build pkgconf libeigen3-dev libtomlplusplus-dev libfmt-dev libcli11-dev
  nlohmann-json3-dev libglfw3-dev libimgui-dev libstb-dev libdeflate-dev libgl-dev libegl-dev fonts-dejavu-core"

# To draw: OpenGL in software and windows, opened when wanted.
draw_packages="libosmesa6 libglfw3"

# To test: the test frameworks, Arnoldi's process for large operators, EGL as the second way to draw, a reader of ParaView's files, a display with a small
# window manager and a hand, and a second compiler with sanitizers and a fuzzer.
test_packages="libgtest-dev libgmock-dev libbenchmark-dev libspectra-dev libegl1 libgl1-mesa-dri python3-meshio
  xvfb twm xdotool imagemagick clang-14 libclang-rt-14-dev libomp-14-dev"

# install_missing PACKAGE...: says what is missing and installs that, as root or with sudo.
install_missing() {
  missing=
  for package in "$@"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || status=absent
    [ "$status" = installed ] || missing="$missing $package"
  done
  if [ -z "$missing" ]; then
    echo "All needed packages are installed."
    return
  fi
  echo "Installing Debian packages:$missing"
  as_root=
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || {
      echo "This needs root: install sudo, or run as root: apt-get install --no-install-recommends$missing" >&2
      return 1
    }
    as_root=sudo
  fi
  # shellcheck disable=SC2086  # words are meant
  if ! apt-cache show $missing >/dev/null 2>&1 || ! apt_install $missing; then
    $as_root apt-get update -q
    apt_install $missing
  fi
}

apt_install() {
  log=$(mktemp) || return 1
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
    -o Dpkg::Use-Pty=0 "$@" >"$log" 2>&1 && status=0 || status=$?
  [ "$status" = 0 ] || cat "$log" >&2
  rm -f "$log"
  return "$status"
}
