# A thread of the C library's own, which sleeps for 0.5 s, and one more in Python's calls: 0.8 s.
import ctypes, time
libc = ctypes.CDLL("libc.so.6")
routine = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)
class TimeSpec(ctypes.Structure):
    _fields_ = [("seconds", ctypes.c_long), ("nanoseconds", ctypes.c_long)]
def raw(_):
    libc.syscall(35, ctypes.byref(TimeSpec(0, 300000000)), None)
    return 0
def python(_):
    time.sleep(0.5)
    return 0
start = time.monotonic_ns()
for what in routine(raw), routine(python):
    thread = ctypes.c_ulong()
    libc.pthread_create(ctypes.byref(thread), None, what, None)
    libc.pthread_join(thread, None)
print(time.monotonic_ns() - start)
