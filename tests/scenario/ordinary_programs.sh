#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# What people start besides their robot's programs says the same as natively, and ends the same.
# Topics: ordinary programs, languages, processes.
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
like_native() {
  local wanted said accounting
  wanted=$(bash -c "$1" 2>&1 </dev/null; echo "exit status $?")
  for accounting in measured fixed; do
    said=$("$tcsim" exec --accounting "$accounting" -- bash -c "$1" 2>&1 </dev/null
           echo "exit status $?")
    said=$(without_waits <<<"$said")
    [[ $said == "$wanted" ]] || fail "$accounting: '$1' says '$said' instead of '$wanted'"
  done
}
cat >pools.py <<'PY'
import asyncio, multiprocessing, time

def square(x):
    time.sleep(0.05)
    return x * x

async def cat():
    process = await asyncio.create_subprocess_exec("cat", stdin=-1, stdout=-1)
    print(len((await process.communicate(b"hello" * 10000))[0]), process.returncode)

if __name__ == "__main__":
    for kind in "spawn", "forkserver", "fork":
        with multiprocessing.get_context(kind).Pool(2) as pool:
            print(kind, pool.map(square, range(4)))
    asyncio.run(cat())
PY
like_native 'python3 pools.py'
like_native 'tar cf - -C /usr/share/doc/bash . | gzip -n | sha1sum'
like_native 'seq 100000 | sort -R --random-source=/bin/bash | sort -n --parallel=4 -S 4M | sha1sum'
like_native 'dd if=/dev/zero bs=64k count=20 status=none | sha1sum; timeout 0.1 sleep 3'
# Waits for a handler while a signal is pending that nobody handles, and made raw. Natively it would wait for ever if it were
# kept from its wait until the signal has come: for 0.9 s nobody is.
like_native 'perl -MPOSIX -MTime::HiRes=ualarm -e "\$SIG{ALRM} = sub { print qq(rang\n) };
  sigprocmask(SIG_BLOCK, POSIX::SigSet->new(SIGCHLD)); fork or exit; select undef, undef, undef, 0.05;
  ualarm 900000; sigsuspend(POSIX::SigSet->new); ualarm 900000; syscall 34"'
if command -v g++ >/dev/null; then
  like_native 'echo "int main() { return 3; }" >three.cc; g++ -o three three.cc && ./three'
fi
if command -v git >/dev/null; then
  like_native 'rm -rf kept; git init -q kept; cd kept; echo a >a; git add a
    git -c user.name=a -c user.email=b commit -qm first; git log --format=%s; git status --short'
fi
if command -v xz >/dev/null; then
  like_native 'xz -T4 -c --block-size=256KiB /bin/bash | xz -dc | sha1sum'
fi
if command -v sqlite3 >/dev/null; then
  like_native 'rm -f x; sqlite3 x "create table t(a); insert into t values (1), (2);
    select sum(a) from t"'
fi
if command -v socat >/dev/null; then
  # Some versions tell of the signal that ends them, with the date.
  like_native 'socat TCP-LISTEN:5599,reuseaddr,fork EXEC:cat 2>/dev/null &
    echo hello | socat -t60 - TCP:127.0.0.1:5599,retry=6000,interval=0.01; kill $!'
fi
# One that goes into the background by itself is waited for, and so is one on a terminal of its own.
like_native 'python3 -c "import ctypes, time
ctypes.CDLL(None).daemon(1, 1); time.sleep(0.1); print(7)" | cat'
like_native 'python3 -c "import pty; pty.spawn([\"sh\", \"-c\", \"sleep 0.1; echo 7\"])"'
