# Sourced with $build and $source set: what drives the browser, in $work, which becomes current. $here and
# $work may be set before, to another folder of checks and where they are run.
# Exit 77 (skipped) where the browser or what drives it cannot be had.
: "${here:=$source/tests/daemon/report/page/browser}" "${work:=$build/page_browser}"
skip() { printf 'SKIPPED: %s\n' "$*" >&2; exit 77; }

command -v chromium >/dev/null || skip "no chromium on this machine"
command -v node >/dev/null && command -v npm >/dev/null || skip "no node and npm on this machine"
mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$here"/*.mjs "$work/"
cd "$work"
if ! cmp -s package-lock.json node_modules/.lock-of-install; then
  npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1 ||
    skip "npm ci does not get the driver: $(tail -n 1 npm.log)"
  cp package-lock.json node_modules/.lock-of-install
fi
