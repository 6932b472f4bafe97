#!/bin/sh
# Runs the README's two commands where nothing is installed: in a bare Debian root, on a clone of the commit that is checked out here.
#   tests/bare_root.sh [SUITE [COMMAND...]]    SUITE: bookworm (default) or trixie; COMMAND instead of the two, such as cli/setup.sh
# The root is made by debootstrap (minbase), from the Debian sources that apt has on this machine, and removed at the end.
# Needs root, for debootstrap, chroot and a /proc in the chroot, and 3 GB below TMPDIR (/tmp).
set -eu
cd "$(dirname "$0")/.."
suite=${1:-bookworm}
[ $# = 0 ] || shift
[ $# -gt 0 ] || set -- cli/column.sh tests/run.sh
fail() { echo "bare_root: $1" >&2 && exit 1; }
[ "$(id -u)" = 0 ] || fail "debootstrap, chroot and mounting /proc need root: sudo $0"
for tool in debootstrap unshare chroot git; do
  command -v $tool >/dev/null || fail "there is no $tool: apt-get install debootstrap util-linux git"
done
[ -z "$(git status --porcelain)" ] || echo "bare_root: what is not committed is left out" >&2

root=$(mktemp -d "${TMPDIR:-/tmp}/bare-$suite-XXXXXX")
chmod 755 "$root"  # tests give up root's rights
# Mounts are made in a namespace of their own, which goes with the last process in it.
trap 'rm -rf --one-file-system "$root"' EXIT
trap 'exit 1' INT TERM
part() { printf '\n== %s: %s (%s s so far)\n' "$suite" "$1" "$(($(date +%s) - begin))"; }
begin=$(date +%s)

part "debootstrap"
here=$(. /etc/os-release && echo "$VERSION_CODENAME")
sources=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
  sed -n "s/^\([^ ]*\) $here\(\|-updates\|-security\) /\1 $suite\2 /p" | sort -u)
mirror=$(echo "$sources" | sed -n "s/^\([^ ]*\) $suite main$/\1/p" | head -n 1)
[ -n "$mirror" ] || fail "apt has no Debian source of $here main here"
debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$root.log" 2>&1 || {
  tail -n 20 "$root.log" >&2
  rm -f "$root.log"
  fail "debootstrap failed"
}
rm -f "$root.log"
rm -f "$root"/etc/apt/sources.list.d/*
echo "$sources" | sed 's/^/deb [signed-by=\/usr\/share\/keyrings\/debian-archive-keyring.gpg] /' >"$root/etc/apt/sources.list"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
git clone --quiet --no-hardlinks . "$root/root/hompm"

inside() {
  unshare --mount --pid --fork --kill-child sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" \
    /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin ${http_proxy:+http_proxy="$http_proxy"} sh -c "cd /root/hompm && $1"
}
inside true || fail "cannot mount /proc and chroot: this needs root with CAP_SYS_ADMIN (in a container: --privileged)"
for command in "$@"; do
  part "$command"
  inside "$command"
done
part "done; $(inside "dpkg-query -W -f '\${Installed-Size}\n'" | awk '{ s += $1 } END { printf "%d", s * 1.024e-3 }') MB of packages"
