#!/usr/bin/env bash
# make_gpu_bundle.sh BUILD_DIR: makes BUILD_DIR/gpu-bundle (and .tar.gz), a bundle that runs on a
# machine that has only a driver with libglvnd. Copies the benchmark, the GL tests, their shaders,
# and every library that belongs neither to the C library nor to a graphics driver. Fails if the
# bundle exceeds 60 MiB.
set -euo pipefail
build=$(realpath "$1")
source=$(realpath "$(dirname "$0")/..")
bundle=$build/gpu-bundle
programs="strata-bench gl_test render_edit_test render_picture_test render_thread_test render_paper_test stream_viewer_test"
# These libraries exist on the machine: the C library, and libglvnd with its driver.
own_to_the_machine='^(ld-linux.*|lib(c|m|dl|rt|pthread|resolv)\.so.*|lib(EGL|GL|GLX|GLdispatch|OpenGL|GLESv2)\.so.*|lib(X11|xcb|Xau|Xdmcp|drm|gbm|glapi)\b.*)$'

rm -rf "$bundle"
mkdir -p "$bundle"/{bin,lib,shaders,peer-shaders}
for program in $programs; do
  cp "$build/bin/$program" "$bundle/bin/"
  strip "$bundle/bin/$program"
  ldd "$build/bin/$program" | awk '$3 ~ /^\// {print $3}'
done | sort -u | while read -r library; do
  name=$(basename "$library")
  [[ $name =~ $own_to_the_machine ]] || cp -L "$library" "$bundle/lib/$name"
done
cp -r "$source"/shaders/. "$bundle/shaders/"
cp -r "$source"/tests/bench/peers/shaders/. "$bundle/peer-shaders/"
git -C "$source" rev-parse --short HEAD > "$bundle/commit"
cat > "$bundle/run" <<'RUN'
#!/bin/sh
# ./run PROGRAM [ARGUMENT…]: runs one of the programs in bin/ with the bundle's libraries and
# shaders. ./run tests: runs all GL tests.
here=$(cd "$(dirname "$0")" && pwd)
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export STRATA_SHADERS="$here/shaders" STRATA_PEER_SHADERS="$here/peer-shaders" STRATA_COMMIT=$(cat "$here/commit")
if [ "$1" = tests ]; then
  failed=0
  for test in "$here"/bin/*_test; do "$test" || failed=$((failed + 1)); done
  # Also test painting on the CPU.
  for test in render_edit_test render_picture_test render_paper_test; do
    STRATA_TEST_EDIT_PATH=kernel "$here/bin/$test" || failed=$((failed + 1))
  done
  echo "$failed test programs failed"
  [ "$failed" = 0 ]; exit
fi
program=$1; shift
exec "$here/bin/$program" "$@"
RUN
chmod +x "$bundle/run"
tar -C "$build" -czf "$build/gpu-bundle.tar.gz" gpu-bundle
bytes=$(du -sb "$bundle" | cut -f1)
echo "$bundle: $((bytes / 1024 / 1024)) MiB, packed $(($(stat -c %s "$build/gpu-bundle.tar.gz") / 1024 / 1024)) MiB"
[ "$bytes" -lt $((60 * 1024 * 1024)) ] || { echo "The bundle is larger than 60 MiB." >&2; exit 1; }
