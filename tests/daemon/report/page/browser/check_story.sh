#!/bin/sh
# check_story.sh BUILD SOURCE PAGE [PICTURES]: opens a page of chapters in a browser, wide and narrow. With
# PICTURES it leaves pictures in that folder. Exit 77 (skipped) as driver.sh says.
set -eu
build=$1
source=$2
. "$source/tests/daemon/report/page/browser/driver.sh"
shift 2
node check_story.mjs "$@"
