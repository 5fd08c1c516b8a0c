#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Threads, event loops, processes, pools, queues and signals of Python: each takes the virtual time
# that its sleeps say, and at most what starting interpreters costs besides.
# Topics: languages, threads, processes, containers.
program=$(mktemp --suffix .py)
trap 'rm -f "$program"' EXIT
cat >"$program" <<'PY'
import asyncio, concurrent.futures, multiprocessing, queue, signal, subprocess, threading, time

def took(what, wanted, work):
    start = time.monotonic()
    work()
    passed = time.monotonic() - start
    if not wanted <= passed < wanted + 0.5:
        print(f"{what} took {passed:.4f} s instead of {wanted}", flush=True)

def expect(error, call):
    try:
        call()
    except error:
        return
    print(f"there was no {error}", flush=True)

def nap(seconds):
    time.sleep(seconds)
    return seconds

def threads():
    naps = [threading.Thread(target=nap, args=(i,)) for i in (1, 2, 3)]
    for thread in naps: thread.start()
    for thread in naps: thread.join()

def join_with_timeout():
    thread = threading.Thread(target=nap, args=(10,))
    thread.start()
    took("join's timeout", 1, lambda: thread.join(1))
    thread.join()

def timer():
    event = threading.Event()
    threading.Timer(6, event.set).start()
    event.wait()

async def loop():
    await asyncio.gather(*(asyncio.sleep(i) for i in range(10)))
    try:
        await asyncio.wait_for(asyncio.sleep(100), 2)
    except asyncio.TimeoutError:
        pass
    process = await asyncio.create_subprocess_exec("sleep", "7")
    await process.wait()
    await asyncio.get_running_loop().run_in_executor(None, nap, 5)

def put_later(to):
    time.sleep(3)
    to.put("x")

def process_queue():
    shared = multiprocessing.Queue()
    process = multiprocessing.Process(target=put_later, args=(shared,))
    process.start()
    shared.get()
    process.join()

def process_pool():
    with multiprocessing.Pool(3) as pool:
        pool.map(nap, [1, 2, 3], chunksize=1)

def executor(kind):
    with kind(2) as pool:
        list(pool.map(nap, [1] * 4))

def terminate():
    process = subprocess.Popen(["sleep", "50"])
    time.sleep(1)
    process.terminate()
    process.wait()

def alarm():
    signal.signal(signal.SIGALRM, lambda *_: None)
    signal.alarm(5)
    signal.pause()

def blocked_alarm(wait):
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGALRM])
    signal.alarm(2)
    wait([signal.SIGALRM])
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGALRM])

if __name__ == "__main__":
    took("threads", 3, threads)
    took("join", 10, join_with_timeout)
    took("Event.wait", 4, lambda: threading.Event().wait(4))
    took("Timer", 6, timer)
    took("Queue.get", 2.5, lambda: expect(queue.Empty, lambda: queue.Queue().get(timeout=2.5)))
    took("asyncio", 23, lambda: asyncio.run(loop()))
    took("run", 20, lambda: subprocess.run(["sleep", "20"]))
    took("run's timeout", 3, lambda: expect(subprocess.TimeoutExpired,
                                            lambda: subprocess.run(["sleep", "20"], timeout=3)))
    took("captured", 2, lambda: subprocess.run("sleep 2; echo", shell=True, capture_output=True))
    took("terminate", 1, terminate)
    took("multiprocessing.Queue", 3, process_queue)
    took("multiprocessing.Pool", 3, process_pool)
    took("ThreadPoolExecutor", 2, lambda: executor(concurrent.futures.ThreadPoolExecutor))
    took("ProcessPoolExecutor", 2, lambda: executor(concurrent.futures.ProcessPoolExecutor))
    took("alarm", 5, alarm)
    took("sigwait", 2, lambda: blocked_alarm(signal.sigwait))
    took("sigtimedwait", 3, lambda: signal.sigtimedwait([signal.SIGUSR1], 3))
    print("done")
PY
for accounting in measured fixed; do
  said=$("$tcsim" exec --accounting "$accounting" -- python3 "$program")
  [[ $said == done ]] || fail "$accounting: $said"
done
