// Asynchronous I/O is done by threads that the C library makes for itself; whoever waits for it
// wakes, or times out at the virtual deadline.
#include <aio.h>
#include <fcntl.h>
#include <netdb.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

void WritesAndReads() {
  FILE* file = tmpfile();
  EXPECT(file != nullptr, "%s", strerror(errno));
  char text[] = "written later";
  aiocb request{};
  request.aio_fildes = fileno(file);
  request.aio_buf = text;
  request.aio_nbytes = sizeof text;
  EXPECT(aio_write(&request) == 0, "%s", strerror(errno));
  const aiocb* const list[] = {&request};
  while (aio_error(&request) == EINPROGRESS) aio_suspend(list, 1, nullptr);
  EXPECT(aio_return(&request) == sizeof text, "aio_write");
  char back[sizeof text] = "";
  aiocb* requests[1] = {&request};
  request.aio_buf = back;
  request.aio_lio_opcode = LIO_READ;
  EXPECT(lio_listio(LIO_WAIT, requests, 1, nullptr) == 0, "%s", strerror(errno));
  EXPECT(aio_return(&request) == sizeof text && strcmp(back, text) == 0, "read: %s", back);
  EXPECT(aio_fsync(O_SYNC, &request) == 0, "%s", strerror(errno));
  while (aio_error(&request) == EINPROGRESS) aio_suspend(list, 1, nullptr);
  fclose(file);
}

// Nothing ever comes out of the pipe until the deadline.
void TimesOut() {
  int ends[2];
  EXPECT(pipe(ends) == 0, "pipe");
  char byte = 0;
  aiocb request{};
  request.aio_fildes = ends[0];
  request.aio_buf = &byte;
  request.aio_nbytes = 1;
  EXPECT(aio_read(&request) == 0, "%s", strerror(errno));
  const aiocb* const list[] = {&request};
  const std::int64_t start = Now();
  const timespec timeout = ToTimespec(g_mode == Mode::kNative ? 50 * kMs : 500 * kSecond);
  EXPECT(aio_suspend(list, 1, &timeout) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectWaited(start, ToNs(timeout), 2, "aio_suspend");
  EXPECT(write(ends[1], "x", 1) == 1, "write");
  while (aio_error(&request) == EINPROGRESS) aio_suspend(list, 1, nullptr);
  EXPECT(aio_return(&request) == 1 && byte == 'x', "aio_read");
}

void NamesAreFound() {
  gaicb request{};
  request.ar_name = "127.0.0.1";
  gaicb* requests[] = {&request};
  EXPECT(getaddrinfo_a(GAI_WAIT, requests, 1, nullptr) == 0, "getaddrinfo_a");
  EXPECT(gai_error(&request) == 0, "%s", gai_strerror(gai_error(&request)));
  freeaddrinfo(request.ar_result);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  WritesAndReads();
  TimesOut();
  NamesAreFound();
}
