#include <QCoreApplication>
#include <QElapsedTimer>
#include <QProcess>
#include <cstdio>
int main(int argc, char** argv) {
  QCoreApplication application(argc, argv);
  const char* const commands[] = {"echo hi", "sleep 2; echo later", "cat; sleep 1"};
  for (const char* command : commands) {
    QElapsedTimer timer;
    timer.start();
    QProcess process;
    process.start("/bin/sh", QStringList() << "-c" << command);
    const bool started = process.waitForStarted();
    process.write("what was written");
    process.closeWriteChannel();
    const bool finished = process.waitForFinished();
    printf("%d %d %d %s, %lld ns\n", started, finished, process.exitCode(),
           process.readAllStandardOutput().trimmed().constData(),
           static_cast<long long>(timer.nsecsElapsed()));
  }
  QProcess missing;
  missing.start("/no/such/program", QStringList());
  printf("missing: %d\n", missing.waitForStarted());
}
