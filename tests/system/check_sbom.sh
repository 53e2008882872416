#!/bin/sh
# check_sbom.sh BUILD SOURCE: what the package says that it is made of (SPDX 2.3, tag: value) is whole:
# what the document and each package must have (sections 6 and 7 of the specification), every library
# that a program loads by itself, and what is compiled in.
set -eu
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf '%s\n' "$*" >&2; exit 1; }
SOURCE_DATE_EPOCH=0 "$2/daemon/package/sbom.sh" "$build" "$2" 1.2.3 >"$work/spdx"
SOURCE_DATE_EPOCH=0 "$2/daemon/package/sbom.sh" "$build" "$2" 1.2.3 | cmp -s - "$work/spdx" ||
  fail "not the same twice"

for field in 'SPDXVersion: SPDX-2.3' 'DataLicense: CC0-1.0' 'SPDXID: SPDXRef-DOCUMENT' \
  'DocumentName: mpm-1.2.3' 'Created: 1970-01-01T00:00:00Z' \
  'Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-mpm'; do
  grep -qx "$field" "$work/spdx" || fail "no $field"
done
packages=$(grep -c '^PackageName: ' "$work/spdx")
for field in SPDXID PackageVersion PackageDownloadLocation PackageLicenseConcluded \
  PackageLicenseDeclared PackageCopyrightText Relationship; do
  count=$(awk '/^PackageName: / { inside = 1 } inside' "$work/spdx" | grep -c "^$field: [^ ]")
  [ "$count" -eq "$packages" ] || fail "$packages packages, and $count times $field"
done
[ -z "$(grep '^SPDXID: ' "$work/spdx" | sort | uniq -d)" ] || fail "two of one name"
! grep '^SPDXID: ' "$work/spdx" | grep -v '^SPDXID: SPDXRef-[A-Za-z0-9.-]*$' || fail "no name of SPDX"

# As the loader sees it, of whom sbom.sh does not ask by name.
for library in libc6 libddsc0debian libsqlite3-0 libsystemd0 libyaml-cpp0.7 libssl3; do
  grep -qx "PackageName: $library" "$work/spdx" || fail "no $library"
done
for compiled in libeigen3-dev prometheus-cpp-dev uplot; do
  grep -qx "PackageName: $compiled" "$work/spdx" || fail "no $compiled"
done
locked=$(grep -A1 '"node_modules/uplot"' "$2/daemon/report/page/package-lock.json" |
  sed -n 's/.*"version": "\(.*\)".*/\1/p')
grep -qx "PackageVersion: $locked" "$work/spdx" || fail "another uplot than $locked"
echo "$packages packages"
