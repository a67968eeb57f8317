// Files on disks that are full and in folders that are not there.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "runtime/error.h"
#include "runtime/output/atomic_file.h"
#include "runtime/output/pvd.h"
#include "runtime/output/report.h"
#include "runtime/output/vtu.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const OutputError& error) {
    return error.what();
  }
  return "no error";
}

// The message of `call` in a process of its own that cannot make any file larger than `bytes`.
std::string message_with_file_limit(rlim_t bytes, const std::function<void()>& call) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    signal(SIGXFSZ, SIG_IGN);  // the limit is then an error of write
    const rlimit limit{bytes, bytes};
    const bool limited = setrlimit(RLIMIT_FSIZE, &limit) == 0;
    const std::string message = limited ? message_of(call) : "no limit";
    const bool told = write(ends[1], message.data(), message.size()) == static_cast<ssize_t>(message.size());
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  std::string message;
  char buffer[1024];
  ssize_t count = 0;
  while ((count = read(ends[0], buffer, sizeof buffer)) > 0) message.append(buffer, static_cast<size_t>(count));
  close(ends[0]);
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return message;
}

Frame large_frame() {
  Frame frame;
  frame.x = Eigen::Matrix3Xd::Random(3, 1000);
  return frame;
}

TEST(output_file, a_file_appears_as_a_whole_when_it_is_committed) {
  const TemporaryFolder folder;
  folder.file("a.txt", "before");
  {
    AtomicFile file(folder.path("a.txt"));
    file.write("aft");
    file.write("er");
    EXPECT_EQ(folder.content("a.txt"), "before");
    EXPECT_EQ(folder.files(), 2U);
    file.commit();
  }
  EXPECT_EQ(folder.content("a.txt"), "after");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(output_file, a_file_that_is_not_committed_leaves_nothing) {
  const TemporaryFolder folder;
  folder.file("a.txt", "before");
  { AtomicFile(folder.path("a.txt")).write("after"); }
  EXPECT_EQ(folder.content("a.txt"), "before");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(output_file, two_writers_do_not_meet) {
  const TemporaryFolder folder;
  AtomicFile first(folder.path("a.txt")), second(folder.path("a.txt"));
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(folder.content("a.txt"), "first");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(output_file, places_that_cannot_be_written_are_named_with_the_reason) {
  const TemporaryFolder folder;
  const std::string missing = folder.path("none/a.vtu");
  EXPECT_EQ(message_of([&] { write_vtu(missing, large_frame()); }),
            missing + ": cannot be made: No such file or directory");
  const std::string below_file = folder.file("file", "") + "/a.vtu";
  EXPECT_EQ(message_of([&] { write_vtu(below_file, large_frame()); }),
            below_file + ": cannot be made: Not a directory");
  EXPECT_EQ(message_of([] { write_file("/dev/full", "text"); }),
            "/dev/full: cannot be written: it is not a regular file");
  EXPECT_EQ(message_of([] { write_file("/proc/ergon.txt", "text"); }).substr(0, 33),
            "/proc/ergon.txt: cannot be made: ");
  const std::string name = folder.path(std::string(250, 'a'));  // the temporary's name is too long
  EXPECT_EQ(message_of([&] { write_file(name, "text"); }), name + ": cannot be made: File name too long");
}

TEST(output_file, a_frame_that_does_not_fit_leaves_the_old_one) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.vtu", "before");
  EXPECT_EQ(message_with_file_limit(4096, [&] { write_vtu(path, large_frame()); }),
            path + ": cannot be written: File too large");
  EXPECT_EQ(folder.content("a.vtu"), "before");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(output_file, a_series_that_does_not_fit_keeps_the_frames_it_had) {
  const TemporaryFolder folder;
  PvdSeries series(folder.path("run.pvd"));
  series.add(0, "0.vtu");
  const std::string before = folder.content("run.pvd");
  EXPECT_EQ(message_with_file_limit(before.size(), [&] { series.add(1, "1.vtu"); }),
            folder.path("run.pvd") + ": cannot be written: File too large");
  EXPECT_EQ(folder.content("run.pvd"), before);
  EXPECT_EQ(folder.files(), 1U);
}

TEST(output_file, a_full_disk_is_told_by_the_report) {
  Report report("/dev/full", true);
  EXPECT_EQ(message_of([&] { report.append({}); }), "/dev/full: cannot be written: No space left on device");
}

TEST(output_file, a_report_line_that_does_not_fit_is_taken_back) {
  const TemporaryFolder folder;
  const std::string path = folder.path("report.jsonl");
  EXPECT_EQ(message_with_file_limit(300,
                                    [&] {
                                      Report report(path);
                                      report.append_line(std::string(200, 'a'));
                                      report.append_line(std::string(200, 'b'));
                                    }),
            path + ": cannot be written: File too large");
  EXPECT_EQ(folder.content("report.jsonl"), std::string(200, 'a') + "\n");
}

TEST(output_file, a_report_without_a_folder_is_an_error) {
  const TemporaryFolder folder;
  const std::string path = folder.path("none/report.jsonl");
  EXPECT_EQ(message_of([&] { Report report(path); }),
            path + ": cannot be opened for writing: No such file or directory");
}

}  // namespace
}  // namespace ergon
