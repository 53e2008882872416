#!/bin/sh
# What is guarded by a mutex is used with it held only: clang reads the annotations of
# core/parallel/mutex.hpp.
# check_locks.sh BUILD_DIR, where idlc's headers are. Returns 77 where there is no clang.
set -eu
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."
command -v clang++ >/dev/null || { echo "SKIPPED: no clang++ here" >&2; exit 77; }

if git grep -nE 'std::(mutex|lock_guard|unique_lock|scoped_lock|condition_variable)' -- \
  core config idl sim daemon ':!core/parallel/mutex.hpp' ':!idl/condition_variable.hpp'; then
  echo "use core/parallel/mutex.hpp instead: clang cannot follow the above" >&2
  exit 1
fi

check() {
  clang++ -std=c++20 -fsyntax-only -I. -isystem "$build/idl" -isystem /usr/include/eigen3 \
    -Wthread-safety -Werror=thread-safety "$@"
}

# It does find what is wrong.
if echo '#include "core/parallel/mutex.hpp"
struct Two { mpm::Mutex mutex; int value MPM_GUARDED_BY(mutex) = 0; };
int read(Two& two) { return two.value; }' | check -x c++ - 2>/dev/null; then
  echo "clang does not check core/parallel/mutex.hpp" >&2
  exit 1
fi

files=$(git grep -l '"core/parallel/mutex.hpp"' -- '*.cpp' '*.hpp' ':!idl/condition_variable.hpp' |
  sed 's/\.hpp$/.cpp/' | sort -u)
# shellcheck disable=SC2086  # a list of files
check $files
