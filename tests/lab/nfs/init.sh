#!/usr/bin/env bash
# The first process of the kernel that boot.sh boots. Sets up the server, /srv/x on a disk of 64 MB,
# and its clients at /mnt/c1 and /mnt/c2, each with a network link of its own (the server's ends are
# s1 and s2) and a cache of its own; runs the command; ends the kernel.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
mount -t proc proc /proc
mount -t sysfs sys /sys
# The root is this machine's own: folders that are written to are covered first.
for folder in /run /var/lib/nfs /mnt /srv /dev/shm; do
  mkdir -p $folder
  mount -t tmpfs tmpfs $folder
done
mkdir -p /run/netns /run/rpcbind /run/sendsigs.omit.d /var/lib/nfs/{v4recovery,sm,sm.bak,rpc_pipefs}
touch /var/lib/nfs/etab /var/lib/nfs/rmtab
# shellcheck disable=SC1090 # made by boot.sh
. "$NFS_JOB"
# Shows boot.sh that this kernel runs: a new file each time, because the host only notices times of
# new files.
while touch "$NFS_PULSE.new" && mv "$NFS_PULSE.new" "$NFS_PULSE"; do sleep 5; done &

hostname server
ip link set lo up
for module in sunrpc nfs nfsd nfsv3 nfsv4 veth sch_netem; do
  modprobe $module || echo "no kernel module $module"
done
{ mkfs.ext4 -q -F /dev/ubda && mkdir -p /srv/x && mount /dev/ubda /srv/x; } || echo "no disk"
chmod 777 /srv/x
mount -t nfsd nfsd /proc/fs/nfsd
echo 10 > /proc/fs/nfsd/nfsv4leasetime
echo 10 > /proc/fs/nfsd/nfsv4gracetime
rpcbind -w
exportfs -i -o rw,no_root_squash,insecure,no_subtree_check,fsid=0,sync '*:/srv/x'
rpc.mountd --port 20048
rpc.nfsd 4

case $NFS_VERSION in
  3) export_path=/srv/x options=vers=3,nolock,mountport=20048 ;;
  *) export_path=/ options=vers=$NFS_VERSION ;;
esac
for i in 1 2; do
  ip netns add c$i
  ip link add s$i type veth peer name c$i netns c$i
  ip addr add 10.9.$i.1/24 dev s$i
  ip link set s$i up
  ip -n c$i addr add 10.9.$i.2/24 dev c$i
  ip -n c$i link set c$i up
  mkdir -p /mnt/c$i
  # An NFSv4 server identifies a client by its name: two with one name would be one client.
  # shellcheck disable=SC2016 # for the inner shell
  nsenter --net=/run/netns/c$i unshare --uts bash -c 'hostname "$1"; shift; exec "$@"' _ client$i \
    mount -t nfs -o "$options,hard,proto=tcp" 10.9.$i.1:$export_path /mnt/c$i
done
export NFS_VERSION
"${NFS_COMMAND[@]}"
echo $? > "$NFS_CODE"
umount -f -l /mnt/c1 /mnt/c2
sync
echo o > /proc/sysrq-trigger
sleep 2
