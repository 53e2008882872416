#!/bin/sh
# check.sh BUILD SOURCE [PICTURES]: a simulated unit and its monitor with the operator page, in a browser.
# Leaves pictures in that folder, BUILD/operator_page where none is named. Exit 77 (skipped) as
# driver.sh says.
set -eu
build=$1
source=$2
pictures=${3:-$build/operator_page}
here=$source/tests/daemon/http/browser
work=$build/operator_page_browser
. "$source/tests/daemon/report/page/browser/driver.sh"
mkdir -p "$pictures"
node check.mjs "$build/bin" "$source" "$pictures"
