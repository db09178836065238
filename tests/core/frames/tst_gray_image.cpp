// Frames of all formats are converted to brightness, and damaged ones are refused.
#include "core/base/error.h"
#include "core/format/picture_header.h"
#include "core/frames/gray_image.h"
#include "tests/support/file_cost.h"
#include "tests/support/test_program.h"

#include <QRegularExpression>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace {

using namespace evical;
using namespace evical::test;

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 2> kScan = {0xFF, 0xDA};

Frame rawFrame(FrameFormat format, Resolution size, Bytes bytes) {
  Frame frame;
  frame.format = format;
  frame.size_px = size;
  frame.bytes = std::move(bytes);
  return frame;
}

Frame encodedFrame(Bytes bytes) {
  return rawFrame(FrameFormat::Encoded, {}, std::move(bytes));
}

cv::Mat ramp(int width, int height) {
  cv::Mat picture(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(20 + 3 * x + 2 * y);
  return picture;
}

Bytes encoded(const std::string& extension, const cv::Mat& picture) {
  Bytes bytes;
  cv::imencode(extension, picture, bytes);
  return bytes;
}

std::string refusalOf(const Frame& frame) {
  try {
    decodeFrame(frame, "frame 7");
  } catch (const CalibrationError& error) {
    return error.kind() == ErrorKind::BadInput && error.place() == "frame 7" ? error.what() : "";
  }
  return "";
}

void putBigEndian(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (int k = 0; k < 4; ++k)
    bytes[at + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(value >> (24 - 8 * k));
}

class TestGrayImage : public QObject {
  Q_OBJECT
 private slots:
  void colours_areWeighedByTheirNames_data();
  void colours_areWeighedByTheirNames();
  void bayer_beginsWithTheNamedColour_data();
  void bayer_beginsWithTheNamedColour();
  void bayerOfSixteenBits_isInterpolatedBeforeItIsScaled_data();
  void bayerOfSixteenBits_isInterpolatedBeforeItIsScaled();
  void rowsWithGaps_areReadWithoutThem();
  void sixteenBits_areScaledByTheirBrightest_data();
  void sixteenBits_areScaledByTheirBrightest();
  void encoded_isDecoded_data();
  void encoded_isDecoded();
  void encodedOfSixteenBits_isScaled();
  void turnForShow_isIgnored();
  void cutOff_isRefused_data();
  void cutOff_isRefused();
  void absurdSize_isRefused_data();
  void bombs_costLittle_data();
  void bombs_costLittle();
  void textsOfAPng_areLeftOut();
  void absurdSize_isRefused();
  void otherSizeThanAnnounced_isRefused();
  void rawFrameWithTooFewBytes_isRefused_data();
  void rawFrameWithTooFewBytes_isRefused();
  void spoiltBytes_areReadOrRefused();
};

void TestGrayImage::colours_areWeighedByTheirNames_data() {
  QTest::addColumn<FrameFormat>("format");
  QTest::addColumn<Bytes>("red");
  QTest::newRow("rgb") << FrameFormat::Rgb8 << Bytes{255, 0, 0};
  QTest::newRow("bgr") << FrameFormat::Bgr8 << Bytes{0, 0, 255};
  QTest::newRow("rgba") << FrameFormat::Rgba8 << Bytes{255, 0, 0, 9};
  QTest::newRow("bgra") << FrameFormat::Bgra8 << Bytes{0, 0, 255, 9};
}

// Red counts for 0.299 (ITU-R BT.601), blue for 0.114.
void TestGrayImage::colours_areWeighedByTheirNames() {
  QFETCH(const FrameFormat, format);
  QFETCH(const Bytes, red);
  QCOMPARE(static_cast<int>(decodeFrame(rawFrame(format, {1, 1}, red), "").pixels[0]), 76);
}

void TestGrayImage::bayer_beginsWithTheNamedColour_data() {
  QTest::addColumn<FrameFormat>("format");
  QTest::addColumn<int>("red_x");
  QTest::addColumn<int>("red_y");
  QTest::newRow("rggb") << FrameFormat::BayerRggb8 << 0 << 0;
  QTest::newRow("bggr") << FrameFormat::BayerBggr8 << 1 << 1;
  QTest::newRow("gbrg") << FrameFormat::BayerGbrg8 << 0 << 1;
  QTest::newRow("grbg") << FrameFormat::BayerGrbg8 << 1 << 0;
}

void TestGrayImage::bayer_beginsWithTheNamedColour() {
  QFETCH(const FrameFormat, format);
  QFETCH(const int, red_x);
  QFETCH(const int, red_y);
  Bytes bytes(64, 0);
  for (int y = red_y; y < 8; y += 2)
    for (int x = red_x; x < 8; x += 2) bytes[static_cast<std::size_t>(8 * y + x)] = 255;
  const GrayImage image = decodeFrame(rawFrame(format, {8, 8}, bytes), "");
  for (int y = 2; y < 6; ++y)
    for (int x = 2; x < 6; ++x)
      QVERIFY(std::abs(image.pixels[static_cast<std::size_t>(8 * y + x)] - 76) <= 2);
}

void TestGrayImage::bayerOfSixteenBits_isInterpolatedBeforeItIsScaled_data() {
  QTest::addColumn<FrameFormat>("format");
  QTest::addColumn<int>("red_x");
  QTest::addColumn<int>("red_y");
  QTest::newRow("rggb of 16 bit") << FrameFormat::BayerRggb16 << 0 << 0;
  QTest::newRow("bggr of 16 bit") << FrameFormat::BayerBggr16 << 1 << 1;
  QTest::newRow("gbrg of 16 bit") << FrameFormat::BayerGbrg16 << 0 << 1;
  QTest::newRow("grbg of 16 bit") << FrameFormat::BayerGrbg16 << 1 << 0;
}

// Red on the left, white on the right, which determines the scale.
void TestGrayImage::bayerOfSixteenBits_isInterpolatedBeforeItIsScaled() {
  QFETCH(const FrameFormat, format);
  QFETCH(const int, red_x);
  QFETCH(const int, red_y);
  for (const bool big_endian : {false, true}) {
    Bytes bytes;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const std::uint16_t value = x >= 4 || (x % 2 == red_x && y % 2 == red_y) ? 4095 : 0;
        const std::uint8_t low = value & 0xFF, high = value >> 8;
        bytes.push_back(big_endian ? high : low);
        bytes.push_back(big_endian ? low : high);
      }
    Frame frame = rawFrame(format, {8, 8}, bytes);
    frame.big_endian = big_endian;
    const GrayImage image = decodeFrame(frame, "");
    for (int y = 2; y < 6; ++y) {
      QVERIFY(std::abs(image.pixels[static_cast<std::size_t>(8 * y + 2)] - 76) <= 2);
      QVERIFY(image.pixels[static_cast<std::size_t>(8 * y + 6)] >= 253);
    }
  }
}

void TestGrayImage::rowsWithGaps_areReadWithoutThem() {
  Frame frame = rawFrame(FrameFormat::Gray8, {2, 2}, {1, 2, 99, 3, 4});
  frame.row_bytes = 3;
  QCOMPARE(decodeFrame(frame, "").pixels, (Bytes{1, 2, 3, 4}));
}

void TestGrayImage::sixteenBits_areScaledByTheirBrightest_data() {
  QTest::addColumn<bool>("big_endian");
  QTest::addColumn<int>("brightest");
  QTest::newRow("10 bits") << false << 1023;
  QTest::newRow("12 bits, big endian") << true << 4095;
  QTest::newRow("16 bits") << false << 65535;
}

void TestGrayImage::sixteenBits_areScaledByTheirBrightest() {
  QFETCH(const bool, big_endian);
  QFETCH(const int, brightest);
  Frame frame = rawFrame(FrameFormat::Gray16, {100, 1}, {});
  frame.big_endian = big_endian;
  for (int x = 0; x < 100; ++x) {
    const int value = x < 50 ? brightest : brightest / 2;
    for (const int byte : {big_endian ? value >> 8 : value & 255, big_endian ? value & 255 : value >> 8})
      frame.bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  const GrayImage image = decodeFrame(frame, "");
  QCOMPARE(static_cast<int>(image.pixels[0]), 255);
  QVERIFY(std::abs(image.pixels[99] - 127) <= 1);
}

void TestGrayImage::encoded_isDecoded_data() {
  QTest::addColumn<std::string>("extension");
  QTest::addColumn<int>("tolerance");
  QTest::newRow("PNG") << std::string(".png") << 0;
  QTest::newRow("JPEG") << std::string(".jpg") << 6;
  QTest::newRow("PGM") << std::string(".pgm") << 0;
  QTest::newRow("TIFF") << std::string(".tiff") << 0;
  QTest::newRow("BMP") << std::string(".bmp") << 0;
}

void TestGrayImage::encoded_isDecoded() {
  QFETCH(const std::string, extension);
  QFETCH(const int, tolerance);
  const cv::Mat picture = ramp(40, 30);
  const Bytes bytes = encoded(extension, picture);
  QCOMPARE(pictureSize({reinterpret_cast<const char*>(bytes.data()), bytes.size()}), (Resolution{40, 30}));
  const GrayImage image = decodeFrame(encodedFrame(bytes), "");
  QCOMPARE(image.size_px, (Resolution{40, 30}));
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      QVERIFY(std::abs(image.pixels[static_cast<std::size_t>(40 * y + x)] - picture.at<std::uint8_t>(y, x)) <=
              tolerance);
}

void TestGrayImage::encodedOfSixteenBits_isScaled() {
  cv::Mat picture;
  ramp(40, 30).convertTo(picture, CV_16U, 16.0);
  for (const char* extension : {".png", ".tiff", ".pgm"}) {
    const GrayImage image = decodeFrame(encodedFrame(encoded(extension, picture)), "");
    const auto range = std::minmax_element(image.pixels.begin(), image.pixels.end());
    QCOMPARE(static_cast<int>(*range.second), 255);
    QVERIFY(std::abs(*range.first - 255 * 20 / 195) <= 2);
  }
}

// The pixels keep the sensor's orientation: the orientation flag of a JPEG is ignored.
void TestGrayImage::turnForShow_isIgnored() {
  Bytes bytes = encoded(".jpg", ramp(40, 30));
  const Bytes exif = {0xFF, 0xE1, 0, 34, 'E', 'x', 'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8,
                      0,    1,    1, 18, 0,   3,   0,   0,   0, 1, 0,   6,   0, 0,  0, 0, 0, 0};
  bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
  QCOMPARE(cv::imdecode(bytes, cv::IMREAD_GRAYSCALE).cols, 30);  // the flag is set, as OpenCV shows
  QCOMPARE(decodeFrame(encodedFrame(bytes), "").size_px, (Resolution{40, 30}));
}

void TestGrayImage::cutOff_isRefused_data() {
  encoded_isDecoded_data();
}

void TestGrayImage::cutOff_isRefused() {
  QFETCH(const std::string, extension);
  const Bytes whole = encoded(extension, ramp(200, 100));
  for (const double part : {0.0, 0.001, 0.01, 0.1, 0.5, 0.9}) {
    const auto length = static_cast<std::ptrdiff_t>(part * static_cast<double>(whole.size()));
    const std::string refusal = refusalOf(encodedFrame(Bytes(whole.begin(), whole.begin() + length)));
    QVERIFY2(!refusal.empty(), std::to_string(part).c_str());
  }
}

void TestGrayImage::absurdSize_isRefused_data() {
  QTest::addColumn<Frame>("frame");
  Bytes png = encoded(".png", ramp(40, 30));
  putBigEndian(png, 16, 60000);
  putBigEndian(png, 20, 60000);
  QTest::newRow("PNG") << encodedFrame(png);
  const std::string pgm = "P5 100000 100000 255\n";
  QTest::newRow("PGM") << encodedFrame(Bytes(pgm.begin(), pgm.end()));
  QTest::newRow("raw") << rawFrame(FrameFormat::Gray8, {2000000000, 2000000000}, Bytes(100));
  QTest::newRow("raw, nothing") << rawFrame(FrameFormat::Gray8, {0, 0}, {});
}

void TestGrayImage::absurdSize_isRefused() {
  QFETCH(const Frame, frame);
  QVERIFY(QString::fromStdString(refusalOf(frame)).contains("which is implausible"));
}

void TestGrayImage::otherSizeThanAnnounced_isRefused() {
  Frame frame = encodedFrame(encoded(".png", ramp(40, 30)));
  frame.size_px = {30, 40};
  QVERIFY(
      QString::fromStdString(refusalOf(frame)).contains("40 x 30 pixels instead of the specified 30 x 40"));
}

void TestGrayImage::rawFrameWithTooFewBytes_isRefused_data() {
  QTest::addColumn<FrameFormat>("format");
  QTest::addColumn<int>("bytes");
  QTest::newRow("gray") << FrameFormat::Gray8 << 99;
  QTest::newRow("16 bits") << FrameFormat::Gray16 << 199;
  QTest::newRow("colours") << FrameFormat::Rgb8 << 299;
  QTest::newRow("none") << FrameFormat::Gray8 << 0;
}

void TestGrayImage::rawFrameWithTooFewBytes_isRefused() {
  QFETCH(const FrameFormat, format);
  QFETCH(const int, bytes);
  const Frame frame = rawFrame(format, {10, 10}, Bytes(static_cast<std::size_t>(bytes)));
  QVERIFY(QString::fromStdString(refusalOf(frame)).contains("truncated"));
}

void TestGrayImage::bombs_costLittle_data() {
  QTest::addColumn<Frame>("frame");
  QTest::addColumn<QString>("says");
  QTest::newRow("PNG, one shade") << encodedFrame(
                                         encoded(".png", cv::Mat(12000, 12000, CV_8UC1, cv::Scalar(0))))
                                  << "12000 x 12000 pixels, which is implausible";
  Bytes text = encoded(".png", ramp(40, 30));
  const Bytes chunk = {0x7F, 0xFF, 0xFF, 0xFF, 't', 'E', 'X', 't', 'a', 0, 0, 0, 0, 0};
  text.insert(text.begin() + 33, chunk.begin(), chunk.end());
  QTest::newRow("PNG, text of 2 GB") << encodedFrame(text) << "damaged or truncated";
  cv::Mat noise(4000, 4000, CV_8UC1);
  cv::randu(noise, 0, 255);
  Bytes jpeg;
  cv::imencode(".jpg", noise, jpeg, {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_QUALITY, 5});
  const auto last = std::find_end(jpeg.begin(), jpeg.end(), kScan.begin(), kScan.end());
  const Bytes scan(last, jpeg.end() - 2);
  for (int k = 0; k < 200; ++k) jpeg.insert(jpeg.end() - 2, scan.begin(), scan.begin() + 40);
  QTest::newRow("JPEG, scans") << encodedFrame(jpeg) << "has 2\\d\\d scans, too many for a picture";
}

void TestGrayImage::bombs_costLittle() {
  QFETCH(const Frame, frame);
  QFETCH(const QString, says);
  const FileCost cost = costOf([&] { return refusalOf(frame); });
  VERIFY_COST(cost, says);
}

void TestGrayImage::textsOfAPng_areLeftOut() {
  Bytes png = encoded(".png", ramp(40, 30));
  const Bytes chunk = {0, 0, 0, 2, 't', 'E', 'X', 't', 'a', 0, 1, 2, 3, 4};  // of a wrong checksum
  png.insert(png.begin() + 33, chunk.begin(), chunk.end());
  const GrayImage image = decodeFrame(encodedFrame(png), "frame 7");
  QVERIFY(image.pixels == decodeFrame(encodedFrame(encoded(".png", ramp(40, 30))), "frame 7").pixels);
}

// Any changed byte results in an image of the right size or a refusal, never anything else.
void TestGrayImage::spoiltBytes_areReadOrRefused() {
  std::mt19937 random(5);
  for (const char* extension : {".png", ".jpg", ".pgm", ".tiff", ".bmp"}) {
    const Bytes whole = encoded(extension, ramp(40, 30));
    for (int k = 0; k < 40; ++k) {
      Bytes spoilt = whole;
      spoilt[std::min<std::size_t>(random() % 64 + (k % 2) * (random() % spoilt.size()), spoilt.size() - 1)] =
          static_cast<std::uint8_t>(random());
      try {
        const GrayImage image = decodeFrame(encodedFrame(spoilt), "");
        QCOMPARE(image.pixels.size(), static_cast<std::size_t>(image.size_px.pixelCount()));
      } catch (const CalibrationError& error) {
        QCOMPARE(error.kind(), ErrorKind::BadInput);
      }
    }
  }
}

}  // namespace

EVICAL_TEST(TestGrayImage)
#include "tst_gray_image.moc"
