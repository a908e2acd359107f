#!/usr/bin/env bash
# A private Slurm on hosts in network namespaces, for the labs that source this after lab.sh: host 1
# is the controller, the others are nodes.
# shellcheck disable=SC2154 # what lab.sh sets
export PATH=$PATH:/usr/sbin:/sbin
slurm=$work/slurm

slurm_down() {
  hosts_down
  [ ! -s "$slurm/munged.pid" ] || kill "$(cat "$slurm/munged.pid")" 2> /dev/null || true
}
# The configuration lines shared by the labs; $1 is the number of hosts.
common_configuration() {
  cat << END
ClusterName=lab
SlurmctldHost=${hosts_prefix}1(10.77.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$slurm/munge.sock
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd-%n.pid
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool-%n
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd-%n.log
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=10
SchedulerParameters=sched_interval=2,bf_interval=2,batch_sched_delay=0
KillWait=3
PartitionName=lab Nodes=${hosts_prefix}[2-$1] Default=YES MaxTime=60 State=UP
END
}
# $1 hosts; the lines of the standard input are added to slurm.conf.
slurm_up() {
  local i
  mkdir -p "$slurm/state"
  chmod 755 "$work" "$slurm"
  # The nodes' lines must come before the partition's.
  { cat; common_configuration "$1"; } > "$slurm/slurm.conf"
  dd if=/dev/urandom of="$slurm/key" bs=128 count=1 status=none
  chmod 600 "$slurm/key"
  munged --force --key-file="$slurm/key" --socket="$slurm/munge.sock" \
    --pid-file="$slurm/munged.pid" --log-file="$slurm/munged.log" --seed-file="$slurm/seed"
  export SLURM_CONF=$slurm/slurm.conf
  on_host 1 slurmctld -c
  for i in $(seq 2 "$1"); do start_node "$i"; done
}
start_node() {
  mkdir -p "$slurm/spool-$hosts_prefix$1"
  on_host "$1" slurmd
}
nodes_idle() {
  [ "$(on_host 1 sinfo --noheader --format %T --Node | grep -c '^idle$')" -ge "$1" ]
}
no_jobs() {
  [ -z "$(on_host 1 squeue --noheader)" ]
}
