// Texts of strangers in exported files: names, streams, reasons and versions that would be code if a file did
// not quote them. Each file is parsed, or run, by a program of its language.
#include "core/base/plain_text.h"
#include "core/export/export_text.h"
#include "core/export/read_back.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QDir>
#include <QFile>
#include <QProcess>
#include <QStandardPaths>
#include <QTemporaryDir>

using namespace evical;
using namespace evical::test;

namespace {

// Code that a language would run if the text became code: each creates the file `canary`.
const std::string kPython = "open('canary','w')", kShell = "touch canary",
                  kOctave = "fclose(fopen('canary','w'))";

// 40 beginnings and more; code of each language follows on what may be a new line.
const std::vector<std::pair<const char*, std::string>> kTexts = {
    {"CR", "a\r"},
    {"LF", "a\n"},
    {"CR LF", "a\r\n"},
    {"VT", "a\v"},
    {"FF", "a\f"},
    {"NUL", std::string("a\0", 2)},
    {"FS", "a\x1c"},
    {"RS", "a\x1e"},
    {"NEL", "a\xc2\x85"},
    {"line separator", "a\xe2\x80\xa8"},
    {"paragraph separator", "a\xe2\x80\xa9"},
    {"ESC", "a\x1b[2J\x1b]0;title\x07"},
    {"backspace", "a\b\b"},
    {"tab", "a\t"},
    {"DEL", "a\x7f"},
    {"CSI of 8 bits", "a\xc2\x9b"},
    {"right to left", "a\xe2\x80\xae"},
    {"isolate", "a\xe2\x81\xa6"},
    {"no character", "a\xef\xbf\xbe"},
    {"Latin 1", "l\xf6g"},
    {"byte of NEL", "a\x85"},
    {"overlong LF", "a\xc0\x8a"},
    {"surrogate", "a\xed\xa0\x80"},
    {"quote", "a' + "},
    {"double quote", "a\", "},
    {"three quotes", "a\"\"\"'''"},
    {"backslash at the end", "a\\"},
    {"command", "$(touch canary)"},
    {"backticks", "`touch canary`"},
    {"semicolon", "a; "},
    {"and", "a && "},
    {"end of an XML comment", "a --> <x/> <!-- "},
    {"many hyphens", "-----"},
    {"XML", "<a b=\"&c;\"/>]]>"},
    {"C comment", "a */ "},
    {"MATLAB's block comment", "%{"},
    {"MATLAB's string", "a'); fclose(fopen('canary','w')); disp('"},
    {"YAML comment", "a # b"},
    {"YAML map", "a: {b: [c, "},
    {"YAML tag", "!!python/object/apply:os.system [touch canary]"},
    {"YAML document", "--- &a *a\n..."},
    {"format", "{} {0} %s %n"},
    {"encoding UTF-7", "-*- coding: utf-7 -*- +AAo-open('canary','w')+AAo-"},
    {"encoding Latin 1", "vim: set fileencoding=latin-1 :"},
    {"ROS substitution", "$(eval __import__('os').system('touch canary'))"},
    {"another folder", "../../canary"},
    {"option", "-rf"},
    {"truth value", "yes"},
    {"nothing", "null"},
    {"number", "1e5"},
    {"long", std::string(200, 'x')},
};

// All languages' code after the text, each on a separate line if the text ends one.
std::string nasty(const std::string& text) {
  return text.size() > 100 || text == "yes" || text == "null" || text == "1e5"
             ? text
             : text + kPython + text + kShell + text + kOctave + text;
}

NamedResult nastyResult(const std::string& text) {
  NamedResult named = rig({});
  for (auto* const sensors : {&named.cameras, &named.imus})
    for (SensorDescription& sensor : *sensors) {
      const std::string last = &sensor == &sensors->front() ? "" : std::to_string(&sensor - sensors->data());
      const bool reference = sensor.name == named.reference;
      sensor.name = text + (sensors == &named.imus ? "i" : "") + last;
      sensor.stream = nasty(text) + sensor.name;
      if (sensors == &named.imus) sensor.accelerometer_stream = "/b" + nasty(text);
      if (reference) named.reference = sensor.name;
    }
  named.version = nasty(text);
  CalibrationResult& own = ownResult(named);
  own.status = CalibrationStatus::Doubtful;
  own.reason = nasty(text);
  own.notes = {nasty(text)};
  return named;
}

void write(const QString& path, const std::string& content) {
  QVERIFY(QDir().mkpath(QFileInfo(path).path()));
  QFile file(path);
  QVERIFY(file.open(QIODevice::WriteOnly));
  QCOMPARE(file.write(content.data(), static_cast<qint64>(content.size())),
           static_cast<qint64>(content.size()));
}

// Debian's, which has PyYAML, NumPy and h5py if they are installed.
QString pythonProgram() {
  return QFile::exists("/usr/bin/python3") ? "/usr/bin/python3" : QStandardPaths::findExecutable("python3");
}

// Parses or runs each file below the folder; prints one line per problem, and what it could not try.
const char* const kLoader = R"PY(
import glob, json, os, runpy, subprocess, sys, types, warnings, xml.etree.ElementTree as xml
try: import yaml
except ImportError: yaml = None
try: import numpy
except ImportError: numpy = None
try: import h5py
except ImportError: h5py = None
warnings.simplefilter('error', SyntaxWarning)
os.mkdir('bin')
with open('bin/ros2', 'w') as f: f.write('#!/bin/sh\n[ $# = 21 ] || echo "$#" > arguments\n')
os.chmod('bin/ros2', 0o755)
for name, members in {'launch': ['LaunchDescription'], 'launch_ros': [], 'launch_ros.actions': ['Node']}.items():
    module = types.ModuleType(name)
    for member in members: setattr(module, member, lambda *a, **k: (a, k))
    sys.modules[name] = module
octave = None
import shutil
octave = shutil.which('octave-cli') or shutil.which('octave')

def load(path):
    ending = os.path.splitext(path)[1]
    if ending in ('.yaml', '.yml'):
        with open(path, encoding='utf-8', newline='') as f: text = f.read()
        if text.startswith('%YAML:1.0\n'): text = text.split('\n', 1)[1]
        if not yaml: return
        class Loader(yaml.SafeLoader): pass
        Loader.add_constructor('tag:yaml.org,2002:opencv-matrix', lambda l, n: l.construct_mapping(n))
        yaml.load(text, Loader)
    elif ending == '.json':
        with open(path, encoding='utf-8') as f: json.load(f)
    elif ending in ('.launch', '.urdf'): xml.parse(path)
    elif ending == '.py': runpy.run_path(path)['generate_launch_description']()
    elif ending == '.sh':
        subprocess.run(['sh', path], check=True, env=dict(os.environ, PATH=os.path.abspath('bin') + ':' + os.environ['PATH']))
        if os.path.exists('arguments'): raise ValueError('other arguments')
    elif ending == '.npz' and numpy:
        for array in numpy.load(path).values(): assert not array.dtype.hasobject
    elif ending == '.h5' and h5py:
        with h5py.File(path) as f: f.visititems(lambda name, item: item[()] if isinstance(item, h5py.Dataset) else None)
    elif ending == '.m' and octave:
        subprocess.run([octave, '--no-gui', '--eval', f"addpath('{os.path.dirname(path)}'); evical_rig();"], check=True)
    elif ending in ('.txt', '.flags'):
        with open(path, encoding='utf-8', newline='') as f: text = f.read()
        if any(len(line.splitlines()) > 1 for line in text.split('\n')): raise ValueError('other ends of a line')

files = sorted(f for f in glob.glob('[0-9]*/**', recursive=True) if os.path.isfile(f))
for path in files:
    try: load(path)
    except BaseException as problem: print(f'{path}: {type(problem).__name__}: {problem}')
    for canary in ('canary', os.path.join(os.path.dirname(path), 'canary')):
        if os.path.exists(canary):
            print(f'{path}: its text was run')
            os.remove(canary)
print(len(files), 'files')
)PY";

}  // namespace

class TestExportTexts : public QObject {
  Q_OBJECT

 private slots:
  void nastyTexts_areTextInEveryLanguage() {
    QTemporaryDir folder;
    QStringList not_same;
    int number = 0;
    for (const auto& [what, text] : kTexts) {
      const NamedResult named = nastyResult(text);
      const std::string own = folder.filePath(QString::number(number++)).toStdString();
      for (const ExportTarget& target : exportTargets()) {
        const ExportedFiles exported = exportTo(named, target.name);
        for (const FileContent& file : exported.files)
          write(QString::fromStdString((own / file.path).string()), contentOf(file));
        const ExportCheck check = checkExport(named, target, own);
        if (!check.same) not_same << QString("%1: ").arg(what) + QString::fromStdString(check.text);
      }
    }
    QVERIFY2(not_same.isEmpty(), qPrintable(not_same.join('\n')));
    if (pythonProgram().isEmpty()) QSKIP("python3 is missing: no file is parsed");
    QProcess python;
    python.setWorkingDirectory(folder.path());
    python.start(pythonProgram(), {"-c", kLoader});
    QVERIFY(python.waitForFinished(300'000));
    const QByteArray printed = python.readAllStandardOutput();
    QVERIFY2(printed.count('\n') == 1, printed);  // how many files
    QVERIFY2(printed.split(' ').value(0).toInt() > 40 * 23, printed + python.readAllStandardError());
    QVERIFY(!QFile::exists(folder.filePath("canary")) && !QFile::exists(folder.path() + "/../canary"));
  }

  // The text reads back unchanged, as far as its characters are visible.
  void quotes_keepTheText() {
    for (const auto& [what, text] : kTexts)
      for (const Language language : {Language::Yaml, Language::Json}) {
        const std::string read = YAML::Load(stringIn(language, text)).as<std::string>();
        QVERIFY2(read == printable(text), what);
        QVERIFY2(hasControl(text) ? read != text : read == text || read == printable(text), what);
      }
  }

  void check_findsOtherComments_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<QString>("file");
    QTest::addColumn<QByteArray>("before");
    QTest::addColumn<QByteArray>("after");
    QTest::newRow("YAML, the verdict")
        << "kalibr"
        << "camchain.yaml" << QByteArray("Calibration: ok") << QByteArray("Calibration: fine");
    QTest::newRow("YAML, at the end of a line")
        << "kalibr"
        << "imu.yaml" << QByteArray("# rad/s/sqrt(Hz)") << QByteArray("# deg/s/sqrt(Hz)");
    QTest::newRow("Python, code after CR") << "ros"
                                           << "static_transforms.launch.py" << QByteArray("Calibration: ok")
                                           << QByteArray("Calibration: ok\rimport os");
    QTest::newRow("YAML, NEL") << "kalibr"
                               << "camchain.yaml" << QByteArray("Calibration: ok")
                               << QByteArray("Calibration: ok\xc2\x85");
    QTest::newRow("XML") << "ros"
                         << "rig.urdf" << QByteArray("Calibration: ok") << QByteArray("Calibration: no");
    QTest::newRow("MATLAB") << "matlab"
                            << "evical_rig.m" << QByteArray("% Written by") << QByteArray("% Made by");
    QTest::newRow("text") << "numpy"
                          << "README.txt" << QByteArray("Calibration: ok") << QByteArray("Calibration: no");
  }
  void check_findsOtherComments() {
    QFETCH(QString, target);
    QFETCH(QString, file);
    QFETCH(QByteArray, before);
    QFETCH(QByteArray, after);
    const NamedResult named = rig({});
    QTemporaryDir folder;
    for (const FileContent& each : exportTo(named, target.toStdString()).files)
      write(folder.filePath(QString::fromStdString(each.path.string())), contentOf(each));
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QVERIFY(checkExport(named, row, folder.path().toStdString()).same);
    QFile changed(folder.filePath(target + "/" + file));
    QVERIFY(changed.open(QIODevice::ReadWrite));
    QByteArray content = changed.readAll();
    QVERIFY(content.contains(before));
    changed.resize(0);
    changed.write(content.replace(before, after));
    changed.close();
    const ExportCheck check = checkExport(named, row, folder.path().toStdString());
    QVERIFY(!check.same);
    QVERIFY2(check.text.find(file.toStdString()) != std::string::npos, check.text.c_str());
  }

  // Lines of an editor, and of the user.
  void check_acceptsAddedComments() {
    const NamedResult named = rig({});
    QTemporaryDir folder;
    for (const FileContent& each : exportTo(named, "kalibr").files) {
      QByteArray content = QByteArray::fromStdString(contentOf(each));
      write(folder.filePath(QString::fromStdString(each.path.string())),
            content.prepend("# mine\n").replace("\n", "\r\n").toStdString());
    }
    const ExportCheck check = checkExport(named, exportTarget("kalibr", "test"), folder.path().toStdString());
    QVERIFY2(check.same, check.text.c_str());
  }

  void sensorOfAFilesName_isRefused() {
    NamedResult named = rig({});
    named.cameras[0].name = "vins";
    try {
      exportTo(named, "vins-fusion");
      QFAIL("one file replaced the other");
    } catch (const CalibrationError& error) {
      QVERIFY2(std::string(error.what()).find("vins.yaml") != std::string::npos, error.what());
    }
  }
};

EVICAL_TEST(TestExportTexts)
#include "tst_export_texts.moc"
