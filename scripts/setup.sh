# ./run and ./test source this file. It installs missing packages on Debian 12 and changes nothing
# else on the machine. It sets STRATA_CMAKE_ARGS. It is quick if no package is missing. Callers must
# set pipefail.
# shellcheck shell=bash
# shellcheck disable=SC2034  # the scripts that source this use the lists of packages

# shellcheck source=scripts/progress.sh
. "$(dirname "${BASH_SOURCE[0]}")/progress.sh"

if [ -t 2 ]; then bold=$'\033[1m' red=$'\033[31m' plain=$'\033[0m'; else bold='' red='' plain=''; fi
say() { printf '%s%s%s\n' "$bold" "$*" "$plain" >&2; }
die() { printf '%s%s%s\n' "$red" "$*" "$plain" >&2; exit 1; }

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null; then sudo "$@"
  else die "This step needs root: $* — run as root, or install sudo."; fi
}

# Uses one query for all packages, which takes a few milliseconds. On a new machine, dpkg-query has
# no entry for most packages, so it fails.
missing_packages() {
  local installed package
  installed=$({ dpkg-query -W -f='${Package} ${Status}\n' "$@" 2>/dev/null || true; } | awk '/install ok installed/ {print $1}')
  for package in "$@"; do grep -qx -- "$package" <<<"$installed" || echo "$package"; done
}

apt_updated=
update_package_lists() {
  [ -z "$apt_updated" ] || return 0
  in_step "reading what the archive has" as_root apt-get update -qq ||
    fail_step "The lists of packages could not be read."
  apt_updated=1
}

# The option --no-remove prevents apt from removing an installed package to resolve a conflict.
install_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  command -v apt-get >/dev/null || die "Strata is built on Debian 12, but this system has no apt-get. To use a container, see docker/README.md."
  [ "$(id -u)" = 0 ] || command -v sudo >/dev/null || die "Packages are missing: ${missing[*]}. Run this as root, or install sudo."
  begin_step Packages
  # Without this setting, Debian's PostgreSQL starts an unneeded cluster.
  if [[ " ${missing[*]}" == *" postgresql"* ]] && [ ! -e /etc/postgresql-common/createcluster.conf ]; then
    as_root mkdir -p /etc/postgresql-common
    echo 'create_main_cluster = false' | as_root tee /etc/postgresql-common/createcluster.conf >/dev/null
  fi
  update_package_lists
  # The progress uses a separate descriptor, because apt closes this descriptor before it runs dpkg.
  # With standard output instead, dpkg's scripts would have no standard output.
  # shellcheck disable=SC2016  # the inner shell expands its parameters
  as_root env DEBIAN_FRONTEND=noninteractive sh -c 'exec apt-get "$@" 3>&1' apt-get -q -o Dpkg::Use-Pty=0 -o APT::Status-Fd=3 \
    install -y --no-install-recommends --no-remove "${missing[@]}" 2>&1 | show_apt_progress ||
    fail_step "Could not install: ${missing[*]}."
  end_step
}

# Lists the conflicting packages that can be installed on this machine. setup_conflicting unpacks
# the others.
installable_conflicting() {
  # Boost 1.81 conflicts with Debian's 1.74.
  [ -z "$(missing_packages libboost1.74-dev)" ] || echo libboost1.81-dev
  # Raptor's development package depends on one flavor of libcurl's development package, which
  # conflicts with the other flavors. Strata also uses libcurl, and any flavor is suitable.
  if [ -n "$(missing_packages libcurl4-openssl-dev)" ] && [ -n "$(missing_packages libcurl4-nss-dev)" ]; then echo libraptor2-dev
  else echo libraptor2-0; fi
}

# Any version of Node from 18 is suitable. Debian's Node is installed only if the machine
# has no Node.
node_packages() {
  if ! command -v node >/dev/null || ! command -v npm >/dev/null; then printf '%s\n' nodejs npm; fi
}

# packages_to_build: prints the packages that are needed to build the server and the page, one per
# line.
packages_to_build() {
  printf '%s\n' "${build_packages[@]}"
  installable_conflicting
  node_packages
}

build_packages=(g++ cmake ninja-build pkg-config ccache mold git python3 python3-yaml ca-certificates
  libegl-dev libgl-dev libepoxy-dev libglm-dev libpq-dev nlohmann-json3-dev libvalijson-dev libsimdjson-dev
  libturbojpeg0-dev libjpeg62-turbo-dev libsodium-dev libssl-dev libspdlog-dev libcli11-dev libzstd-dev zlib1g-dev libbrotli-dev libpng-dev libtiff-dev libwebp-dev libstb-dev
  libembree-dev libmeshoptimizer-dev libopenmesh-dev libqhull-dev libeigen3-dev libopen3d-dev libfmt-dev libdraco-dev libzip-dev libshp-dev libgeos-dev libproj-dev libsqlite3-dev libxlsxwriter-dev libutf8proc-dev libpango1.0-dev libpugixml-dev libqpdf-dev liblcms2-dev libexpected-dev)
run_packages=(libegl1 libopengl0 libegl-mesa0 libgl1-mesa-dri postgresql-15 fonts-dejavu-core fonts-liberation2 curl)
test_packages=(libgtest-dev libgmock-dev dpkg-dev chromium openssl libpcre2-8-0 poppler-utils qpdf clang-format-14 clang-tidy-16 black flake8 isort shellcheck xz-utils python3-pytest python3-pandas python3-openpyxl python3-ezdxf python3-rdflib gdal-bin)
fuzz_packages=(clang-14 libclang-rt-14-dev llvm-14)

# unpack_beside PACKAGE FILE-OF-IT WHY: unpacks a package into build/deps if it should not be
# installed.
unpack_beside() {
  local package=$1 file=$2 why=$3 deps=$PWD/build/deps
  [ ! -e "$deps/$file" ] || return 0
  say "Unpacking $package into build/deps: $why"
  mkdir -p "$deps"
  update_package_lists
  (cd "$deps" && apt-get -qq -o APT::Sandbox::User=root download "$package" && dpkg -x "$package"_*.deb . && rm -f "$package"_*.deb) ||
    die "Could not download $package."
}

# Sets STRATA_CMAKE_ARGS to the folders of the unpacked libraries.
setup_conflicting() {
  STRATA_CMAKE_ARGS=()
  if [ -n "$(missing_packages libboost1.81-dev)" ]; then
    unpack_beside libboost1.81-dev usr/include/boost/version.hpp "it conflicts with a package that is installed and stays"
    STRATA_CMAKE_ARGS+=(-DSTRATA_BOOST_INCLUDE="$PWD/build/deps/usr/include")
  fi
  if [ -n "$(missing_packages libraptor2-dev)" ]; then
    unpack_beside libraptor2-dev usr/include/raptor2/raptor2.h "it conflicts with a package that is installed and stays"
    STRATA_CMAKE_ARGS+=(-DSTRATA_RAPTOR_INCLUDE="$PWD/build/deps/usr/include/raptor2")
  fi
}

# The tests run nginx in front of the server. An installed nginx would start a server and use port
# 80.
setup_nginx() {
  PATH=$PATH:/usr/sbin command -v nginx >/dev/null || unpack_beside nginx usr/sbin/nginx "if it were installed, it would start a server"
}

# The programs of examples/cluster. They are not installed, because the packages of etcd and Patroni
# start services. Patroni needs some Python packages, which are unpacked if they are not installed.
python_of_patroni=(python3-cdiff python3-click python3-colorama python3-dateutil python3-dnspython python3-etcd python3-pkg-resources
  python3-prettytable python3-psutil python3-psycopg2 python3-six python3-urllib3 python3-wcwidth python3-yaml)
setup_cluster() {
  local package why="if it were installed, it would start a service"
  setup_nginx
  unpack_beside etcd-server usr/bin/etcd "$why"
  unpack_beside patroni usr/bin/patroni "$why"
  for package in $(missing_packages "${python_of_patroni[@]}"); do
    unpack_beside "$package" "usr/share/doc/$package/copyright" "Patroni needs it"
  done
}

# The next major version of PostgreSQL, from Debian 13, for the test of `strata upgrade-database`. It
# is unpacked with the libraries of Debian 13 that it needs, because it does not run with the
# libraries of Debian 12. The programs are in build/deps/debian13/usr/lib/postgresql/17/bin.
newer_postgresql=(postgresql-17 postgresql-client-17 libpq5 libc6 libgcc-s1 libstdc++6 libicu76 libssl3t64 libldap2 libsasl2-2
  libxml2 libxslt1.1 liblzma5 liblz4-1 libzstd1 zlib1g libpam0g libaudit1 libcap-ng0 libcap2 libsystemd0 libselinux1 libpcre2-8-0
  libgssapi-krb5-2 libkrb5-3 libk5crypto3 libkrb5support0 libcom-err2 libkeyutils1 libreadline8t64 libtinfo6 libuuid1 libxxhash0)
setup_newer_postgresql() {
  local folder=$PWD/build/deps/debian13 apt=$PWD/build/deps/debian13-apt stamp options
  stamp=$(printf '%s\n' "${newer_postgresql[@]}" | sha256sum)
  ! is_current newer-postgresql "$stamp" || [ ! -e "$folder/usr/lib/postgresql/17/bin/pg_upgrade" ] || return 0
  begin_step "PostgreSQL 17 for a test"
  rm -rf "$folder" "$apt"
  mkdir -p "$folder" "$apt"/{lists,cache/archives}/partial
  echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian trixie main" >"$apt/sources.list"
  # Uses separate package lists, so that the machine never installs a package of Debian 13.
  options=(-qq -o "Dir::Etc::sourcelist=$apt/sources.list" -o Dir::Etc::sourceparts=/dev/null -o "Dir::State::lists=$apt/lists"
    -o "Dir::Cache=$apt/cache" -o APT::Sandbox::User=root)
  in_step "reading what Debian 13 has" apt-get "${options[@]}" update || fail_step "The lists of packages could not be read."
  (cd "$apt" && in_step "downloading" apt-get "${options[@]}" download "${newer_postgresql[@]}") || fail_step "PostgreSQL 17 could not be downloaded."
  local package
  for package in "$apt"/*.deb; do dpkg -x "$package" "$folder" || fail_step "Could not unpack $package."; done
  wrap_programs "$folder/usr/lib/postgresql/17"
  rm -rf "$apt"
  end_step
  write_stamp newer-postgresql "$stamp"
}

# wrap_programs FOLDER: replaces each program in FOLDER/bin by a script that runs it with the
# libraries that are unpacked with it.
wrap_programs() {
  local program
  mv "$1/bin" "$1/programs"
  mkdir "$1/bin"
  for program in "$1"/programs/*; do
    cat >"$1/bin/${program##*/}" <<'END'
#!/bin/sh
here=${0%/*}
for loader in "$here"/../../../*/ld-linux-*.so.*; do
  exec "$loader" --library-path "${loader%/*}" --argv0 "$0" "$here/../programs/${0##*/}" "$@"
done
END
  done
  chmod 755 "$1"/bin/*
}

# The S3 server of the tests is OpenStack Swift (tests/e2e/s3). Its package depends on
# twice as many packages as Swift imports. Therefore, only the imported packages are unpacked.
python_of_swift=(liberasurecode1 libxml2 libxslt1.1 python3-certifi python3-cffi-backend python3-chardet python3-charset-normalizer
  python3-cryptography python3-dnspython python3-eventlet python3-greenlet python3-idna python3-lxml python3-netifaces python3-openssl
  python3-paste python3-pastedeploy python3-pastedeploy-tpl python3-pkg-resources python3-pyeclib python3-requests python3-six
  python3-tempita python3-urllib3 python3-xattr)
setup_s3() {
  local package
  for package in $(missing_packages "${python_of_swift[@]}"); do
    unpack_beside "$package" "usr/share/doc/$package/copyright" "the S3 server of the tests needs it"
  done
  unpack_beside python3-swift usr/lib/python3/dist-packages/swift/__init__.py "it is the S3 server of the tests"
}

require_node() {
  local major
  major=$(node -p 'process.versions.node.split(".")[0]')
  [ "$major" -ge 18 ] || die "Node $major is too old: 18 or newer is needed."
}

# A stamp contains the checksum of the source files of a result.
# stamp_of: prints the stamp of the files on standard input. is_current NAME STAMP: succeeds if the
# stored stamp is STAMP.
stamp_of() { xargs -d '\n' sha256sum | sha256sum; }
is_current() { [ "$(cat "build/stamps/$1" 2>/dev/null)" = "$2" ]; }
write_stamp() {
  mkdir -p build/stamps
  echo "$2" >"build/stamps/$1"
}

# The source of the page is web-client. The source of its guide is docs. The built guide is in
# web-client/dist/guide, where the server finds it.
modules_stamp() { printf '%s\n' "$1/package.json" "$1/package-lock.json" | stamp_of; }
modules_are_current() { [ -d "$1/node_modules" ] && is_current "${1//\//-}-modules" "$(modules_stamp "$1")"; }
web_client_stamp() {
  find web-client/src web-client/public web-client/*.html web-client/*.json web-client/*.ts \
    protocol/generated/openapi.json -type f 2>/dev/null | sort | stamp_of
}
guide_stamp() {
  find docs web-client/src/shell/*.css -path docs/node_modules -prune -o -path docs/.vitepress/cache -prune -o -path docs/.vitepress/dist -prune -o \
    -type f -print | sort | stamp_of
}
page_is_current() {
  modules_are_current web-client && [ -f web-client/dist/index.html ] && is_current web-client "$(web_client_stamp)"
}
guide_is_current() { modules_are_current docs && [ -f docs/.vitepress/dist/index.html ] && is_current docs "$(guide_stamp)"; }
web_client_is_current() { page_is_current && guide_is_current && [ -f web-client/dist/guide/index.html ]; }

# setup_modules FOLDER
setup_modules() {
  require_node
  modules_are_current "$1" && return 0
  in_step "installing modules of $1" npm --prefix "$1" ci --no-audit --no-fund --loglevel=error || fail_step "npm ci failed in $1."
  write_stamp "${1//\//-}-modules" "$(modules_stamp "$1")"
}
setup_web_client() {
  web_client_is_current && return 0
  begin_step Page
  if ! page_is_current; then
    setup_modules web-client
    in_step "building" npm --prefix web-client run --silent build || fail_step "The page did not build."
    write_stamp web-client "$(web_client_stamp)"
  fi
  if ! guide_is_current; then
    setup_modules docs
    in_step "building the guide" npm --prefix docs run --silent build || fail_step "The guide did not build."
    write_stamp docs "$(guide_stamp)"
  fi
  rm -rf web-client/dist/guide
  cp -r docs/.vitepress/dist web-client/dist/guide
  end_step
}

# in_background COMMAND…: runs a command without input while the script continues. Its output is
# in the file $background_output. The end of the script also ends the command.
# await_background: returns the status of the command.
background='' background_output=''
end_background() {
  [ -z "$background" ] || kill -- "-$background" 2>/dev/null
  [ -z "$background_output" ] || rm -f "$background_output"
}
in_background() {
  end_background
  background_output=$(mktemp)
  trap end_background EXIT
  set -m  # a separate process group, which includes the processes that the command starts
  "$@" </dev/null >"$background_output" 2>&1 &
  background=$!
  set +m
}
await_background() {
  local status=0
  wait "$background" || status=$?
  background=''
  return "$status"
}

# Prints random bytes for `shuf` that only the commit decides. A history that is short or absent has
# too few of them, so numbers follow.
bytes_of_commit() {
  git rev-list --max-count=100 HEAD 2>/dev/null
  printf '%s\n' {1..1000}
}

# The number of compilers that run at the same time: one for each core, fewer if memory is short.
# The compiler can need 1.2 GB of memory for one source file.
build_jobs() {
  local cores memory
  cores=$(nproc) memory=$(awk '/^MemAvailable/ { print int($2 / 1200000) }' /proc/meminfo)
  if [ "$memory" -lt "$cores" ]; then echo $((memory > 1 ? memory : 1)); else echo "$cores"; fi
}

# needs_build PRESET [TARGET…]: succeeds if there are units to compile.
needs_build() {
  local preset=$1
  shift
  [ -f "build/$preset/build.ninja" ] || return 0
  ! ninja -C "build/$preset" -n "$@" 2>/dev/null | grep -q '^ninja: no work to do'
}

# configure_and_build PRESET [TARGET…]
configure_and_build() {
  # A unit usually takes 1.6 seconds of one core.
  local preset=$1 targets=() jobs=${STRATA_BUILD_JOBS:-$(build_jobs)} name=Server unit_ms=1600 weight
  shift
  needs_build "$preset" "$@" || return 0
  [ "$preset" = release ] || name="Server and tests ($preset)"
  [ $# = 0 ] || targets=(--target "$@")
  begin_step "$name"
  if [ ! -f "build/$preset/build.ninja" ]; then
    in_step "looking for libraries" cmake --preset "$preset" "${STRATA_CMAKE_ARGS[@]}" || fail_step "cmake failed."
  fi
  weight=$(ninja -C "build/$preset" -n "${targets[@]:1}" | weigh_units)
  NINJA_STATUS='[%f/%t] ' cmake --build "build/$preset" -j "$jobs" "${targets[@]}" 2>&1 |
    show_ninja_progress "$weight" $((unit_ms / jobs)) || fail_step "The build failed."
  end_step
}
