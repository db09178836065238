// A locale with decimal commas, created with localedef, since test machines have no such locale.
#pragma once

#include <QProcess>
#include <QString>
#include <QTemporaryDir>

#include <clocale>
#include <cstdlib>

namespace evical::test {

// During its lifetime, strtod reads "0,5".
class GermanLocale {
 public:
  GermanLocale() {
    const QString locale = folder_.filePath("de_DE.UTF-8");
    QProcess::execute("localedef", {"-i", "de_DE", "-f", "UTF-8", locale});
    qputenv("LOCPATH", folder_.path().toUtf8());
    there_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr && std::strtod("0,5", nullptr) == 0.5;
  }
  ~GermanLocale() {
    std::setlocale(LC_ALL, "C");
    qunsetenv("LOCPATH");
  }
  GermanLocale(const GermanLocale&) = delete;
  GermanLocale& operator=(const GermanLocale&) = delete;

  bool isInstalled() const { return there_; }

 private:
  QTemporaryDir folder_;
  bool there_ = false;
};

}  // namespace evical::test
