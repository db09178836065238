// SPDX-License-Identifier: GPL-3.0-or-later
// A folder on an almost full disk: a small file system in memory if the system permits mounting one (visible
// to this process only), otherwise a limit on the size of files.
#pragma once

#include <QDir>
#include <QTemporaryDir>

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <csignal>

namespace evical::ui::test {

class FullDisk {
 public:
  FullDisk() {
    const QByteArray path = folder_.path().toUtf8();
    mounted_ = unshare(CLONE_NEWNS) == 0 && mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               mount("full", path.constData(), "tmpfs", 0, "size=8k") == 0;
    if (mounted_) return;
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit little{4096, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    if (mounted_) {
      umount2(folder_.path().toUtf8().constData(), MNT_DETACH);
      return;
    }
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

  QString path() const { return folder_.path(); }
  QStringList files() const { return QDir(folder_.path()).entryList(QDir::Files | QDir::Hidden); }

 private:
  QTemporaryDir folder_;
  bool mounted_ = false;
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

}  // namespace evical::ui::test
