#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$source_root/tests/as_nobody.sh"
# `tcsim doctor` says what robots with networks of their own take, and what of it is missing. A run of such robots finds
# the same: with all of it; without /dev/net/tun; where that is root's alone; where TCP's timers cannot be turned off;
# where the kernel makes no networks; in a chroot whose / is no mount point; as root without CAP_SYS_ADMIN.
# Topics: doctor, network, rights.
((EUID == 0)) || exit 77  # to take away what there is
command -v python3 >/dev/null || exit 77
"$source_root/tests/scenario/can_have_networks.sh" || exit 77
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
chmod 755 "$out"
install_for_everybody "$build" "$out"
mkdir -m 777 "$out/run"
printf '%s\n' 'duration: 10ms' 'network: {latency: 1ms}' 'robots:' '  near: {clients: {name: {command: [hostname]}}}' \
  '  far: {clients: {name: {command: [hostname]}}}' >"$out/world.yaml"

doctor() {  # of the networks: verdict, what was found, how to mend it
  "$@" "$out/bin/tcsim" doctor --json | python3 -c '
import json, sys
(f,) = [f for f in json.load(sys.stdin) if f["name"] == "networks of robots"]
print(f["verdict"], f["found"], f["mend"], sep="\n")'
}
runs=0
fly() {
  "$@" timeout 200 "$out/bin/tcsim" run "$out/world.yaml" --accounting fixed --out "$out/run/$((++runs))" >"$out/said" 2>&1
}

works() {  # WORDS COMMAND...
  local words=$1 finding
  shift
  finding=$(doctor "$@")
  [[ $finding == ok$'\n'*"$words"* ]] || fail "$*: the doctor says $finding"
  fly "$@" || fail "$*: the doctor sees nothing missing, but: $(cat "$out/said")"
}
lacks() {  # REASON MEND COMMAND...
  local reason=$1 mend=$2 finding
  shift 2
  finding=$(doctor "$@")
  [[ $finding == warning$'\n'*"$reason"*$'\n'*"$mend"* ]] || fail "$*: the doctor says $finding"
  ! fly "$@" || fail "$*: the doctor sees $reason, but it runs"
  grep -qF "$reason); " "$out/said" && grep -qF "$mend" "$out/said" || fail "$*: the run says $(cat "$out/said")"
}
# CHANGES...: a shell's words, for a mount namespace of their own; what follows runs in it.
with() { printf '%s\n' "$1"' && exec "$@"'; }
changed() { unshare --mount sh -c "$(with "$1")" sh "${@:2}"; }
own_device='mount -t tmpfs -o mode=755 none /dev/net && mknod /dev/net/tun c 10 200'

works 'namespaces and /dev/net/tun'
works 'user namespaces and /dev/net/tun' changed "$own_device && chmod 666 /dev/net/tun" "${nobody[@]}"
lacks '/dev/net/tun: No such file or directory' 'modprobe tun' changed 'mount -t tmpfs none /dev/net'
lacks '/dev/net/tun: Permission denied' 'chmod 666 /dev/net/tun' changed "$own_device && chmod 600 /dev/net/tun" "${nobody[@]}"
lacks '/proc/sys/net: Read-only file system' '/proc/sys for writing' changed 'mount --bind /proc/sys /proc/sys && mount -o remount,bind,ro /proc/sys'
lacks 'unshare: No space left on device' 'sysctl -w user.max_net_namespaces=1000' \
  unshare --user --map-root-user sh -c "$(with 'echo 0 >/proc/sys/user/max_net_namespaces')" sh
works 'user namespaces and /dev/net/tun' changed "$own_device && chmod 666 /dev/net/tun" \
  setpriv --bounding-set=-sys_admin --inh-caps=-sys_admin
if [[ -e $build/bin/in_container_profile ]]; then
  install -m 755 -t "$out/bin" "$build/bin/in_container_profile"
  lacks 'a seccomp filter on unshare: Operation not permitted' 'start tcsim outside of the filter' \
    changed "$own_device && chmod 666 /dev/net/tun" "${nobody[@]}" "$out/bin/in_container_profile"
fi

# A chroot as debootstrap leaves it: a folder, with what the kernel has mounted in it.
mkdir "$out/root"
for folder in /*; do
  if [[ -L $folder ]]; then cp -P "$folder" "$out/root/"; elif [[ -d $folder ]]; then mkdir "$out/root$folder"; fi
done
chmod 1777 "$out/root/tmp"
mkdir -p "$out/root$out"
in_chroot="for folder in /*; do
  [ -L \$folder ] || [ ! -d \$folder ] || [ \$folder = /tmp ] || mount --rbind \$folder $out/root\$folder
done
mount --bind $out $out/root$out"
own_mounts='mount --make-rslave /: Invalid argument'
lacks "$own_mounts" 'call `mount --rbind / /` and start tcsim by `chroot /.. tcsim`' changed "$in_chroot" chroot "$out/root"
lacks "$own_mounts" 'outside call `mount --rbind DIR DIR`' changed "$in_chroot" chroot "$out/root"
works 'namespaces and /dev/net/tun' changed "$in_chroot" chroot "$out/root" sh -c 'mount --rbind / / && exec chroot /.. "$@"' sh
works 'namespaces and /dev/net/tun' changed "$in_chroot && mount --rbind $out/root $out/root" chroot "$out/root"
lacks 'user namespace, in a chroot: Operation not permitted' 'run tcsim as root, or outside of the chroot' \
  changed "$in_chroot" chroot "$out/root" "${nobody[@]}"
[[ -z $(new_in_shm) ]] || fail "left in /dev/shm: $(new_in_shm)"
