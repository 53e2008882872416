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
# As the documentation has it, by a root who hides what he makes.
umask 027
cp /usr/share/mpm/plants/shell3x3.yaml /etc/mpm/units/
od -An -tx1 -N32 /dev/urandom | tr -d ' \n' >/etc/mpm/token
options() { echo "MPMD_OPTIONS=\"$*\"" >/etc/default/mpmd; }
options --token-file /etc/mpm/token
runuser -u mpm -- mpmd --check --config /etc/mpm/units --token-file /etc/mpm/token >/try/check.log ||
  fail "the service's user may not read: $(cat /try/check.log)"
systemctl start mpmd || fail "does not start"
systemctl is-active -q mpmd || fail "is not active"
echo "started: $(status)"
[ "$(ps -o user= -p "$(pid)")" = mpm ] || fail "runs as another user"
mpmsim --config /usr/share/mpm/plants/shell3x3.yaml --scenario hidden_gain --samples 3000 --speed 300 \
  >/try/mpmsim.log 2>&1 || fail "mpmsim: $(tail -n 1 /try/mpmsim.log)"
wait_for 20 "alarm in the journal" alarmed
echo "alarmed: $(status)"
useradd -G mpm ann
runuser -u ann -- mpm journal >/try/journal.log 2>&1 || fail "no journal for the group: $(cat /try/journal.log)"
grep -q u3 /try/journal.log || fail "the journal does not have the alarm"
! runuser -u nobody -- mpm journal >/dev/null 2>&1 || fail "a journal for anybody"
echo "read: the journal, by who is in the group mpm"
[ -z "$(find /var/lib/mpm -perm /o=rwx)" ] || fail "others may read $(find /var/lib/mpm -perm /o=rwx)"

before=$(pid)
kill -9 "$before"
killed=$(date +%s%N)
comes_back() {  # no process at all is none that is back
  now=$(pid)
  [ "$now" != "$before" ] && [ "$now" != 0 ] && systemctl is-active -q mpmd
}
wait_for 10 "restart after kill -9" comes_back
away=$((($(date +%s%N) - killed) / 1000000))
[ "$away" -le 2000 ] || fail "away for $away ms after kill -9"
goes_on() { [ "$(journalctl -u mpmd --no-pager | grep -c 'goes on behind [1-9]')" -ge "$1" ]; }
wait_for 10 "samples from before" goes_on 1
stands() { status | grep -q '; 1 alarm$'; }
wait_for 10 "alarm after kill -9" stands
echo "killed: back after $away ms: $(status)"

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

before=$(pid)
ended=0
mpmd --config /usr/share/mpm/plants/shell3x3.yaml --state-dir /var/lib/mpm >/try/second.log 2>&1 || ended=$?
[ "$ended" = 2 ] && grep -q "held by process $before " /try/second.log ||
  fail "a second one on its folder: status $ended: $(cat /try/second.log)"
mpm journal --verify >/try/journal.log || fail "verify: $(cat /try/journal.log)"
! journalctl -u mpmd --no-pager | grep -q 'cannot be locked' || fail "the folder is not locked"
echo "locked: a second one on its folder was refused"

unit=/etc/mpm/units/shell3x3.yaml
echo "no_such_key: 1" >>$unit
! systemctl reload mpmd 2>/dev/null || fail "a reload of a bad file fails for nobody"
refused() { status | grep -q "; not reloaded: $unit:[0-9]*:1: error: "; }
wait_for 10 "word of the reload" refused
[ "$(pid)" = "$before" ] || fail "a bad reload is a restart"
cat /usr/share/mpm/plants/shell3x3.yaml >$unit
systemctl reload mpmd || fail "cannot be reloaded after a bad file"
wait_for 10 "alarm after a good reload" stands
echo "reloaded: not with a bad file"

systemctl stop mpmd
[ "$(systemctl show -p Result --value mpmd)" = success ] || fail "a stop is a failure"
runuser -u ann -- mpm journal >/try/journal.log 2>&1 || fail "no journal after a stop: $(cat /try/journal.log)"
tries() { systemctl show -p NRestarts --value mpmd; }
once() {  # WHAT
  ! systemctl start mpmd >/dev/null 2>&1 || fail "starts with $1"
  sleep 5
  [ "$(tries)" -eq 0 ] || fail "tries $1 again"
  systemctl reset-failed mpmd
  echo "refused: $1, once"
}
chmod 600 $unit
once "a unit file that is root's alone"
journalctl -u mpmd --no-pager | grep -q "$unit: error: cannot be read: Permission denied (for user mpm)" ||
  fail "does not say why"
chmod 640 $unit
options --token-file /etc/mpm/none
once "a token file that is not there"
options --no-such-option
once "a bad option"

# A port that is taken: for a moment, and for good (with a pause that makes the test short).
options --http 8080
take_port() {
  mpmd --config /usr/share/mpm/plants/shell3x3.yaml --domain 71 --http 8080 2>/try/other.log &
  other=$!
  wait_for 10 "other monitor" grep -q 'operator page' /try/other.log
}
take_port
! systemctl start mpmd >/dev/null 2>&1 || fail "starts on a port that is taken"
tried() { [ "$(tries)" -ge 2 ]; }
wait_for 20 "second try" tried
kill "$other"
wait_for 20 "start when the port is free" systemctl is-active -q mpmd
systemctl stop mpmd
mkdir /run/systemd/system/mpmd.service.d
printf '[Service]\nRestartSec=100ms\n' >/run/systemd/system/mpmd.service.d/soon.conf
systemctl daemon-reload
take_port
! systemctl start mpmd >/dev/null 2>&1 || fail "starts on a port that is taken"
given_up() { [ "$(systemctl show -p ActiveState --value mpmd)" = failed ]; }
wait_for 90 "end of tries" given_up
[ "$(tries)" -ge 10 ] || fail "gives up after $(tries) tries"
echo "given up: a port that is taken, after $(tries) tries"
kill "$other"
wait "$other" || :
rm -r /run/systemd/system/mpmd.service.d
systemctl daemon-reload
systemctl reset-failed mpmd
systemctl start mpmd || fail "does not start after it gave up"
systemctl stop mpmd

echo nonsense >$unit
once "a bad unit file"

rm $unit
mpm keys --out /etc/mpm/keys >/try/keys.log 2>&1 || fail "no keys: $(cat /try/keys.log)"
chown -R mpm: /etc/mpm/keys/monitor
dpkg --purge mpm >/try/dpkg.log 2>&1 || fail "purge: $(tail -n 1 /try/dpkg.log)"
left=$(find / -xdev \( -path /proc -o -path /sys -o -path /try -o -path /run \) -prune -o \
  \( -name 'mpm*' -o -name '*mpmd*' \) -print)
[ "$(echo "$left" | sort | tr '\n' ' ')" = "/etc/default/mpmd /etc/mpm " ] || fail "left behind: $left"
useradd --system next
[ "$(stat -c %U /etc/mpm/keys/monitor/key.pem)" = mpm ] || fail "the keys are another user's"
echo "removed: but for what the administrator made, and its owner"
echo "package: all right"
