#!/bin/sh
# Builds the Debian package, lets lintian judge it, installs it in a bare Debian root of this machine's release, and runs it there.
# Needs root, debootstrap, lintian and 1 GB below TMPDIR (/tmp).
set -eu
cd "$(dirname "$0")/../.."
for tool in debootstrap lintian chroot; do
  command -v $tool >/dev/null || { echo "deb: there is no $tool: apt-get install debootstrap lintian" >&2 && exit 1; }
done
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
cmake -B build/package -G Ninja -DCMAKE_BUILD_TYPE=Release -DHOMPM_TESTS=OFF -DCMAKE_INSTALL_PREFIX=/usr >/dev/null
cmake --build build/package
rm -f build/package/*.deb
(cd build/package && cpack -G DEB >/dev/null)
# The address of the maintainer is for who publishes the package to set.
lintian --allow-root --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog build/package/hompm_*.deb

root=$(mktemp -d "${TMPDIR:-/tmp}/deb-$suite-XXXXXX")
trap 'rm -rf --one-file-system "$root"' EXIT
trap 'exit 1' INT TERM
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
  sed -n "s/^\([^ ]*\) $suite main$/\1/p" | head -n 1)
debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$root.log" 2>&1 || { tail -n 20 "$root.log" >&2 && exit 1; }
rm -f "$root.log"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
cp build/package/hompm_*.deb "$root/root/hompm.deb"
inside() { chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin ${http_proxy:+http_proxy="$http_proxy"} sh -euc "$1"; }
inside 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends /root/hompm.deb >/root/log 2>&1 || { tail /root/log; exit 1; }'
inside 'hompm-run --version && cd /root && hompm-run --case bar --end-time 0.1 --output mine --quiet && hompm-diff mine mine'
inside 'hompm-study --case bar --list >/dev/null && test -s /usr/share/man/man1/hompm-run.1.gz && test -s /usr/share/hompm/scenes/contact.toml'
echo "deb: installed and run in a bare $suite"
