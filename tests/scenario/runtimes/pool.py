import multiprocessing, socket, sys, threading, time

def square(x):
    time.sleep(0.01)
    return x * x

def pools(workers):
    with multiprocessing.Pool(workers) as pool:
        assert pool.map(square, range(24), chunksize=1) == [x * x for x in range(24)]
        assert list(pool.imap(square, range(24))) == [x * x for x in range(24)]
        assert [pool.apply(square, (x,)) for x in range(5)] == [x * x for x in range(5)]

def flag():
    done = []
    thread = threading.Thread(target=lambda: (time.sleep(0.1), done.append(1)))
    thread.start()
    while not done: time.sleep(0)
    thread.join()

def reads():
    one, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    idle, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    idle.setblocking(False)
    got = []
    thread = threading.Thread(target=lambda: got.append(one.recv(10)))
    thread.start()
    threading.Timer(0.1, lambda: other.send(b"x")).start()
    while not got:
        try: idle.recv(10)
        except BlockingIOError: pass
    thread.join()

def took(what, least, most, work):
    begun = time.monotonic()
    work()
    passed = time.monotonic() - begun
    print(f"{what} took {passed:.9f} s")
    if not least <= passed < most: print(f"that is not {least} s")

workers = int(sys.argv[1])
sleeps = 0.01 * (5 + 2 * (24 // workers))
took("the pools", sleeps, sleeps + 0.05, lambda: pools(workers))
took("the flag", 0.1, 0.15, flag)
took("reading", 0.1, 0.2, reads)
