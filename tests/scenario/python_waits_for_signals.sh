#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Python's waits for signals end at their virtual time: at the deadline, with a timer, with the
# signal of another thread, at the end of a child.
# Topics: languages, signals, timers.
program='
import os, signal, subprocess, threading, time
start = time.monotonic()
def say(what):
    print(what, round(time.monotonic() - start, 1), flush=True)
waited = [signal.SIGALRM, signal.SIGUSR1, signal.SIGCHLD]
signal.pthread_sigmask(signal.SIG_BLOCK, waited)
say(signal.sigtimedwait(waited, 500))
signal.setitimer(signal.ITIMER_REAL, 100, 50)
say(signal.sigwait(waited).name)
say(signal.sigwaitinfo(waited).si_code)
signal.setitimer(signal.ITIMER_REAL, 0)
def send():
    time.sleep(7)
    os.kill(os.getpid(), signal.SIGUSR1)
thread = threading.Thread(target=send)
thread.start()
say(signal.sigwait(waited).name)
thread.join()
child = subprocess.Popen(["sleep", "60"])
say(signal.sigwaitinfo(waited).si_pid == child.pid)
child.wait()
'
expected='None 500.0
SIGALRM 600.0
0 650.0
SIGUSR1 657.0
True 717.0'
for accounting in measured fixed; do
  said=$("$tcsim" exec --accounting $accounting -- python3 -c "$program")
  [[ $said == "$expected" ]] || fail "$accounting: expected $expected, got: $said"
done
