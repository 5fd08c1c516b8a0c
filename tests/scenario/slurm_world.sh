# For the tests of `tcsim trials --launcher slurm`: a cluster of Debian's Slurm on this machine, with a munge of its
# own, a controller, and nodes of one processor each, that all have the machine's files. Nothing of it needs root.
# Source it after common.sh; call end_slurm at the end, whatever happens.
PATH+=:/usr/sbin
for program in munged slurmctld slurmd sbatch; do
  if ! command -v $program >/dev/null; then
    echo "skipped: there is no $program; apt install --no-install-recommends slurmctld slurmd slurm-client munge"
    exit 77
  fi
done
slurm=$(mktemp -d)
slurm_processes=()

start_slurm() {  # NUMBER of nodes: n1, n2, ... [SECONDS] after which one is missed
  local last=$1 missed=${2:-60} host user port node version
  # Ports that no other test has.
  host=$(uname -n) user=$(id -un) port=$((28000 + $$ % 400 * 10))
  host=${host%%.*}
  chmod 755 "$slurm"  # munged wants that of its socket's folder
  mkdir "$slurm"/{state,spool,log}
  for node in $(seq "$last"); do mkdir "$slurm/spool/n$node"; done
  head -c 128 /dev/urandom >"$slurm/munge.key"
  chmod 600 "$slurm/munge.key"
  cat >"$slurm/slurm.conf" <<CONF
ClusterName=tcs
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$slurm/munge.sock
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool/%n
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/%n.pid
SlurmctldLogFile=$slurm/log/slurmctld
SlurmdLogFile=$slurm/log/%n
ProctrackType=proctrack/linuxproc
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SlurmdTimeout=$missed
MessageTimeout=$((missed < 15 ? missed : 15))
KillWait=5
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName=n[1-$last] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + last))] CPUs=1
PartitionName=work Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  # Since Slurm 23 (Debian 13) slurmd wants control groups, if nobody tells it not to; before, that was a mistake.
  version=$(slurmd -V)
  version=${version##* }
  ((${version%%.*} < 23)) || echo "CgroupPlugin=disabled" >"$slurm/cgroup.conf"
  export SLURM_CONF=$slurm/slurm.conf
  munged --foreground --socket="$slurm/munge.sock" --key-file="$slurm/munge.key" --pid-file="$slurm/munge.pid" \
    --log-file="$slurm/log/munge" --seed-file="$slurm/munge.seed" &>/dev/null &
  slurm_processes+=($!)
  for _ in $(seq 600); do [[ -S $slurm/munge.sock ]] && break; sleep 0.1; done
  slurmctld -D -f "$SLURM_CONF" &>/dev/null &
  slurm_processes+=($!)
  for node in $(seq "$last"); do start_node "n$node"; done
  for _ in $(seq 900); do
    (($(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l) == last)) && return
    sleep 0.1
  done
  fail "Slurm does not start: $(tail -n 5 "$slurm"/log/*)"
}

start_node() {  # NAME
  slurmd -D -N "$1" -f "$SLURM_CONF" &>/dev/null &
  printf -v "slurmd_of_$1" %s $!
  slurm_processes+=($!)
}

with_descendants() {  # PROCESS...
  local process
  for process in "$@"; do
    echo "$process"
    # shellcheck disable=SC2046
    with_descendants $(pgrep -P "$process")
  done
}

# The processes that watch over jobs: of a node, or of all. They have their node's log open.
steps_of() {  # [NODE]
  local step
  for step in $(pgrep -x slurmstepd); do
    find "/proc/$step/fd" -lname "$slurm/log/${1:-n*}" 2>/dev/null | grep . >/dev/null && echo "$step"
  done
  true
}

jobs_of() {  # NODE: what sbatch was told to run
  local step
  for step in $(steps_of "$1"); do pgrep -P "$step" || true; done
}

# Slurm takes a moment to clear away behind a job that has ended.
no_jobs() {  # [OPTIONS of squeue]; within $tenths of a second, 300 unless told
  for _ in $(seq "${tenths:-300}"); do [[ -z $(squeue -h "$@") ]] && return; sleep 0.1; done
  fail "jobs are left: $(squeue)"
}

kill_node() {  # NODE: all its processes at once, as if its power were cut
  local slurmd=slurmd_of_$1
  disown "${!slurmd}"  # or bash tells of its end
  # shellcheck disable=SC2046
  kill -9 "${!slurmd}" $(with_descendants $(steps_of "$1")) 2>/dev/null || true
}

end_slurm() {
  set +e
  disown -a
  # shellcheck disable=SC2046
  kill -9 $(with_descendants $(steps_of)) "${slurm_processes[@]}" 2>/dev/null
  local until=$((SECONDS + 5))
  while ((SECONDS < until)) && pgrep -f "$slurm" >/dev/null; do sleep 0.1; done
  pkill -9 -f "$slurm"
  rm -rf "$slurm"
}
