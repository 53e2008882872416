#!/bin/sh
# sbom.sh BUILD SOURCE VERSION: what is in the package, as SPDX 2.3 (tag: value) on standard output: the
# programs, the Debian packages of the libraries that they load, and those of which parts are compiled
# into them, with the versions of this machine, on which they were built.
set -eu
build=$1
source=$2
version=$3
# Headers and archives of which the programs hold compiled code.
compiled_in="libboost-dev libcli11-dev libeigen3-dev nlohmann-json3-dev prometheus-cpp-dev"

commit=$(git -C "$source" rev-parse HEAD 2>/dev/null || echo unknown)
created=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(date +%s)}" +%Y-%m-%dT%H:%M:%SZ)

# package_of FILE: the Debian package that a library comes from. Of /lib and /usr/lib, which are one,
# dpkg knows either.
package_of() {
  real=$(readlink -f "$1")
  for path in "$1" "/usr$1" "${1#/usr}" "$real" "${real#/usr}"; do
    found=$(dpkg-query -S "$path" 2>/dev/null | head -n 1) || found=""
    [ -z "$found" ] || { echo "${found%%:*}"; return; }
  done
  echo "sbom: no package has $1" >&2
  exit 2
}

# Those that the programs themselves ask for.
loaded() {
  for program in mpm mpmd mpmsim; do
    { objdump -p "$build/bin/$program"; ldd "$build/bin/$program"; } |
      awk '$1 == "NEEDED" { asked[$2] } $2 == "=>" && $1 in asked { print $3 }'
  done | sort -u | while read -r library; do package_of "$library"; done | sort -u
}

name_of() { printf %s "$1" | tr -c 'A-Za-z0-9.\n' -; }

# describe PACKAGE RELATION
describe() {
  of=$(dpkg-query -W -f '${Version}' "$1")
  cat <<TEXT

PackageName: $1
SPDXID: SPDXRef-$(name_of "$1")
PackageVersion: $of
PackageSupplier: Organization: Debian
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: false
PackageLicenseConcluded: NOASSERTION
PackageLicenseDeclared: NOASSERTION
PackageCopyrightText: NOASSERTION
PackageComment: <text>Licences in /usr/share/doc/$1/copyright</text>
ExternalRef: PACKAGE-MANAGER purl pkg:deb/debian/$1@$of?arch=$(dpkg --print-architecture)
Relationship: SPDXRef-mpm $2 SPDXRef-$(name_of "$1")
TEXT
}

# npm FOLDER NAME: as it is pinned there.
npm() {
  pinned=$(tr -d '\n' <"$source/$1/package-lock.json" |
    sed -n "s|.*\"node_modules/$2\": *{\([^}]*\)}.*|\1|p")
  field() { printf %s "$pinned" | sed -n "s|.*\"$1\": *\"\([^\"]*\)\".*|\1|p"; }
  sum=$(field integrity)
  cat <<TEXT

PackageName: $2
SPDXID: SPDXRef-npm-$(name_of "$2")
PackageVersion: $(field version)
PackageSupplier: NOASSERTION
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: false
PackageChecksum: SHA512: $(printf %s "${sum#sha512-}" | base64 -d | od -An -tx1 | tr -d ' \n')
PackageLicenseConcluded: $(field license)
PackageLicenseDeclared: $(field license)
PackageCopyrightText: NOASSERTION
ExternalRef: PACKAGE-MANAGER purl pkg:npm/$2@$(field version)
Relationship: SPDXRef-mpm CONTAINS SPDXRef-npm-$(name_of "$2")
TEXT
}

cat <<TEXT
SPDXVersion: SPDX-2.3
DataLicense: CC0-1.0
SPDXID: SPDXRef-DOCUMENT
DocumentName: mpm-$version
DocumentNamespace: https://mpm-monitor.invalid/spdx/mpm-$version-$commit
Creator: Organization: MPM monitor developers
Creator: Tool: daemon/package/sbom.sh
Created: $created

PackageName: mpm
SPDXID: SPDXRef-mpm
PackageVersion: $version
PackageSupplier: Organization: MPM monitor developers
PackageDownloadLocation: NOASSERTION
PackageSourceInfo: <text>git commit $commit</text>
FilesAnalyzed: false
PackageLicenseConcluded: Apache-2.0
PackageLicenseDeclared: Apache-2.0
PackageCopyrightText: <text>2026 The authors of the MPM monitor</text>
Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-mpm
TEXT
loaded_packages=$(loaded)
for package in $loaded_packages; do describe "$package" DYNAMIC_LINK; done
for package in $compiled_in; do describe "$package" STATIC_LINK; done
npm daemon/report/page uplot
