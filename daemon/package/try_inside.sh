# Runs as a service of the container that try.sh boots; says what it sees in /try/said.
exec >/try/said 2>&1
set -eu
fail() { echo "package: $*"; journalctl -u mpmd --no-pager | tail -n 20; exit 1; }
wait_for() {  # SECONDS WHAT COMMAND...
  left=$(($1 * 5)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    left=$((left - 1))
    [ "$left" -gt 0 ] || fail "no $what"
    sleep 0.2
  done
}
pid() { systemctl show -p MainPID --value mpmd; }
status() { systemctl show -p StatusText --value mpmd; }
alarmed() { grep -rqs '"to":"active"' /var/lib/mpm/journal; }

systemctl is-enabled -q mpmd || fail "not enabled"
! systemctl is-active -q mpmd || fail "it runs without a unit file"
cp /usr/share/mpm/plants/shell3x3.yaml /etc/mpm/units/
systemctl start mpmd || fail "does not start"
systemctl is-active -q mpmd || fail "is not active"
echo "started: $(status)"
[ "$(ps -o user= -p "$(pid)")" = mpm ] || fail "runs as another user"
mpmsim --config /usr/share/mpm/plants/shell3x3.yaml --scenario hidden_gain --samples 3000 --speed 300 \
  >/try/mpmsim.log 2>&1 || fail "mpmsim: $(tail -n 1 /try/mpmsim.log)"
wait_for 20 "alarm in the journal" alarmed
echo "alarmed: $(status)"
[ -z "$(find /var/lib/mpm -perm /o=rwx)" ] || fail "others may read $(find /var/lib/mpm -perm /o=rwx)"

before=$(pid)
kill -9 "$before"
comes_back() { systemctl is-active -q mpmd && [ "$(pid)" != "$before" ]; }
wait_for 10 "restart after kill -9" comes_back
goes_on() { [ "$(journalctl -u mpmd --no-pager | grep -c 'goes on behind [1-9]')" -ge "$1" ]; }
wait_for 10 "samples from before" goes_on 1
stands() { status | grep -q '; 1 alarm$'; }
wait_for 10 "alarm after kill -9" stands
echo "killed: back with another process: $(status)"

before=$(pid)
systemctl reload mpmd || fail "cannot be reloaded"
wait_for 10 "unit files read anew" goes_on 2
[ "$(pid)" = "$before" ] || fail "a reload is a restart"
wait_for 10 "alarm after a reload" stands
echo "reloaded: $(status)"

before=$(pid)
dpkg -i /try/mpm.deb >/try/dpkg.log 2>&1 || fail "upgrade: $(tail -n 1 /try/dpkg.log)"
wait_for 10 "restart by the upgrade" comes_back
alarmed || fail "the upgrade lost the journal"
wait_for 10 "samples from before the upgrade" goes_on 3
echo "upgraded: journal and statistics were kept"

systemctl stop mpmd
[ "$(systemctl show -p Result --value mpmd)" = success ] || fail "a stop is a failure"
echo nonsense >/etc/mpm/units/shell3x3.yaml
! systemctl start mpmd >/dev/null 2>&1 || fail "starts with a bad unit file"
sleep 5
[ "$(systemctl show -p NRestarts --value mpmd)" -eq 0 ] || fail "tries a bad unit file again"
echo "refused: a bad unit file, once"

rm /etc/mpm/units/shell3x3.yaml
dpkg --purge mpm >/try/dpkg.log 2>&1 || fail "purge: $(tail -n 1 /try/dpkg.log)"
left=$(find / -xdev \( -path /proc -o -path /sys -o -path /try -o -path /run \) -prune -o \
  \( -name 'mpm*' -o -name '*mpmd*' \) -print)
[ -z "$left" ] || fail "left behind: $left"
! getent passwd mpm || fail "the user is still there"
echo "removed: without a trace"
echo "package: all right"
