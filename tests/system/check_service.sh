#!/bin/sh
# check_service.sh SOURCE: the unit that the package installs is one that systemd takes, and leaves an
# exposure of 2.0 of 10 at most, as systemd rates it.
set -eu
service=$1/daemon/package/mpmd.service
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
# Not installed here: another program stands where the unit's would.
sed 's#^ExecStart=/usr/bin/mpmd#ExecStart=/bin/true#' "$service" >"$copy/mpmd.service"
said=$(systemd-analyze verify --man=no "$copy/mpmd.service" 2>&1 | grep mpmd.service || :)
[ -z "$said" ] || { printf '%s\n' "$said" >&2; exit 1; }
# What fails at once, in two seconds at most, reaches the limit of starts with the pauses between.
setting() { sed -n "s/^$1=//p" "$service"; }
pause=$(setting RestartSec)  # milliseconds
[ $(($(setting StartLimitBurst) * (${pause%ms} + 2000))) -le $(($(setting StartLimitIntervalSec) * 1000)) ] ||
  { echo "a start that always fails would be tried for ever" >&2; exit 1; }
# A key that systemd does not know is only told of; one that it does counts.
systemd-analyze security --offline=yes --threshold=20 "$copy/mpmd.service" | tail -n 1
