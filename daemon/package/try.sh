#!/bin/sh
# try.sh DEB: installs, starts, alarms, kills, upgrades and removes the package on a system of its
# own, made by debootstrap and booted in a container without a network. Needs root.
set -eu
package=$1
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
root=$(mktemp -d /var/tmp/mpm-try.XXXXXX)
chmod 755 "$root"  # it is / in there
trap 'rm -rf "$root"' EXIT
release=$(. /etc/os-release && printf %s "$VERSION_CODENAME")
mirror=$(apt-get indextargets --format '$(SITE)' "Codename: $release" | head -n 1)

debootstrap --variant=minbase --include=systemd-sysv,dbus,procps "$release" "$root" "$mirror" >"$root.log" 2>&1 ||
  { tail -n 20 "$root.log" >&2; exit 2; }
rm -f "$root.log"
mkdir "$root/try"
cp "$package" "$root/try/mpm.deb"
cp "$here/try_inside.sh" "$root/try/"
in_it() { systemd-nspawn -q -D "$root" --register=no --keep-unit "$@"; }
in_it --pipe sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /try/mpm.deb' \
  >"$root/try/apt.log" 2>&1 || { tail -n 20 "$root/try/apt.log" >&2; exit 2; }

cat >"$root/etc/systemd/system/try.service" <<'TEXT'
[Service]
Type=idle
ExecStart=/bin/sh /try/try_inside.sh
ExecStopPost=/bin/systemctl poweroff --no-block
[Install]
WantedBy=multi-user.target
TEXT
ln -s /etc/systemd/system/try.service "$root/etc/systemd/system/multi-user.target.wants/"
timeout 420 systemd-nspawn -q -D "$root" --register=no --keep-unit --private-network -b \
  </dev/null >"$root/try/boot.log" 2>&1 || :
cat "$root/try/said"
tail -n 1 "$root/try/said" | grep -qx 'package: all right'
