# Sourced by ./run and ./test: installs what is missing on Debian 12 and leaves everything else alone.
# Sets STRATA_CMAKE_ARGS. Quick when nothing is missing.
# shellcheck shell=bash
# shellcheck disable=SC2034  # the lists of packages are for who sources this

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }
die() { printf '\033[31m%s\033[0m\n' "$*" >&2; exit 1; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else die "This step needs root: $* — run as root, or install sudo."; fi
}

# A package is there when dpkg says so; asking for all at once takes a few milliseconds.
missing_packages() {
  local installed package
  installed=$(dpkg-query -W -f='${Package} ${Status}\n' "$@" 2>/dev/null | awk '/install ok installed/ {print $1}')
  for package in "$@"; do grep -qx -- "$package" <<<"$installed" || echo "$package"; done
}

apt_updated=
apt_get() {
  export DEBIAN_FRONTEND=noninteractive
  [ -n "$apt_updated" ] || { as_root apt-get update -qq; apt_updated=1; }
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@"
}

# --no-remove: a package of the user's is never taken away to make room for one of ours.
install_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  say "Installing: ${missing[*]}"
  # Without this, Debian's PostgreSQL starts a cluster of its own that nobody asked for.
  if [[ " ${missing[*]}" == *" postgresql"* ]] && [ ! -e /etc/postgresql-common/createcluster.conf ]; then
    as_root mkdir -p /etc/postgresql-common
    echo 'create_main_cluster = false' | as_root tee /etc/postgresql-common/createcluster.conf >/dev/null
  fi
  apt_get install -y --no-install-recommends --no-remove "${missing[@]}" >&2 ||
    die "Could not install: ${missing[*]}. The lines above say why."
}

build_packages=(g++ cmake ninja-build pkg-config ccache mold git python3 python3-yaml ca-certificates
  libegl-dev libgl-dev libepoxy-dev libglm-dev libpq-dev nlohmann-json3-dev libvalijson-dev libsimdjson-dev
  libturbojpeg0-dev libjpeg62-turbo-dev libsodium-dev libssl-dev libspdlog-dev libcli11-dev libzstd-dev zlib1g-dev libbrotli-dev libpng-dev libtiff-dev libwebp-dev libstb-dev
  libembree-dev libmeshoptimizer-dev libopenmesh-dev libqhull-dev libdraco-dev libzip-dev libshp-dev libgeos-dev libsqlite3-dev libxlsxwriter-dev libutf8proc-dev libpango1.0-dev libexpected-dev libgtest-dev libgmock-dev)
run_packages=(libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri postgresql-15 fonts-dejavu-core curl)
test_packages=(chromium openssl libpcre2-8-0 poppler-utils clang-format-14 clang-tidy-16 black flake8 isort shellcheck xz-utils python3-pandas python3-openpyxl)
fuzz_packages=(clang-14 libclang-rt-14-dev llvm-14)

# A package that had better not be installed: its files are unpacked into build/deps instead. unpack_beside PACKAGE FILE-OF-IT WHY
unpack_beside() {
  local package=$1 file=$2 why=$3 deps=$PWD/build/deps
  [ ! -e "$deps/$file" ] || return 0
  say "Unpacking $package into build/deps: $why"
  mkdir -p "$deps"
  [ -n "$apt_updated" ] || { as_root apt-get update -qq; apt_updated=1; }
  (cd "$deps" && apt-get -qq download "$package" && dpkg -x "$package"_*.deb . && rm -f "$package"_*.deb) ||
    die "Could not download $package."
}

# Sets STRATA_CMAKE_ARGS to where the libraries are that are not the system's.
setup_conflicting() {
  STRATA_CMAKE_ARGS=()
  # Boost 1.81 conflicts with Debian's 1.74.
  if [ -n "$(missing_packages libboost1.81-dev)" ]; then
    if [ -n "$(missing_packages libboost1.74-dev)" ]; then install_packages libboost1.81-dev
    else
      unpack_beside libboost1.81-dev usr/include/boost/version.hpp "it conflicts with a package that is installed and stays"
      STRATA_CMAKE_ARGS+=(-DSTRATA_BOOST_INCLUDE="$PWD/build/deps/usr/include")
    fi
  fi
  # Raptor's headers bring libcurl's, which we use as well, of one flavour, which conflict with those of the others; any will do.
  if [ -n "$(missing_packages libraptor2-dev)" ]; then
    if [ -n "$(missing_packages libcurl4-openssl-dev)" ] && [ -n "$(missing_packages libcurl4-nss-dev)" ]; then install_packages libraptor2-dev
    else
      install_packages libraptor2-0
      unpack_beside libraptor2-dev usr/include/raptor2/raptor2.h "it conflicts with a package that is installed and stays"
      STRATA_CMAKE_ARGS+=(-DSTRATA_RAPTOR_INCLUDE="$PWD/build/deps/usr/include/raptor2")
    fi
  fi
}

# nginx is tested in front of the server. Installed, it would start and take port 80.
setup_nginx() {
  PATH=$PATH:/usr/sbin command -v nginx >/dev/null || unpack_beside nginx usr/sbin/nginx "installed, it would start a server of its own"
}

# Any Node from 18 on will do; Debian's is installed only where there is none.
setup_node() {
  if ! command -v node >/dev/null || ! command -v npm >/dev/null; then install_packages nodejs npm; fi
  local major
  major=$(node -p 'process.versions.node.split(".")[0]')
  [ "$major" -ge 18 ] || die "Node $major is too old: 18 or newer is needed."
}

# Rebuilds something only when its inputs changed: stamp FILE COMMAND… with the input paths on standard input.
when_changed() {
  local stamp=$1 sum
  shift
  sum=$(xargs -d '\n' sha256sum | sha256sum)
  [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$sum" ] && return 0
  "$@" || return 1
  mkdir -p "$(dirname "$stamp")"
  echo "$sum" > "$stamp"
}

install_web_modules() {
  (cd web-client && npm ci --no-audit --no-fund --loglevel=error) >&2 || die "npm ci failed in web-client."
}
setup_web_modules() {
  setup_node
  [ -d web-client/node_modules ] || rm -f build/stamps/web-modules
  printf '%s\n' web-client/package.json web-client/package-lock.json | when_changed build/stamps/web-modules install_web_modules
}
build_web_client() {
  say "Building the page"
  (cd web-client && npm run --silent build) >&2 || die "The page did not build."
}
setup_web_client() {
  setup_web_modules
  [ -f web-client/dist/index.html ] || rm -f build/stamps/web-client
  find web-client/src web-client/public web-client/index.html web-client/*.json web-client/*.ts -type f 2>/dev/null | sort |
    when_changed build/stamps/web-client build_web_client
}

# configure_and_build PRESET [TARGET…]
configure_and_build() {
  local preset=$1 targets=()
  shift
  [ $# = 0 ] || targets=(--target "$@")
  if [ ! -f "build/$preset/build.ninja" ]; then
    cmake --preset "$preset" "${STRATA_CMAKE_ARGS[@]}" >&2 || die "cmake failed."
  fi
  cmake --build "build/$preset" -j "${STRATA_BUILD_JOBS:-$(nproc)}" "${targets[@]}" >&2 || die "The build failed."
}
