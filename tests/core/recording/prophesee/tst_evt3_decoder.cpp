#include "core/recording/prophesee/evt3_decoder.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <algorithm>
#include <initializer_list>
#include <string>

using namespace evical;

namespace {

constexpr unsigned kY = 0x0000, kEvent = 0x2000, kBase = 0x3000, kVector12 = 0x4000, kVector8 = 0x5000;
constexpr unsigned kLow = 0x6000, kHigh = 0x8000, kTrigger = 0xA000, kOn = 0x0800;

std::string words(std::initializer_list<unsigned> list) {
  std::string bytes;
  for (const unsigned word : list) {
    bytes.push_back(static_cast<char>(word & 0xFF));
    bytes.push_back(static_cast<char>(word >> 8));
  }
  return bytes;
}

std::vector<std::int64_t> times_us(const std::vector<Event>& events) {
  std::vector<std::int64_t> times;
  for (const Event& event : events) times.push_back(event.time_ns / 1000);
  return times;
}

bool sameForEvt3Decoder(const Event& event, std::int64_t time_us, int x_px, int y_px, bool brighter) {
  return event.time_ns == 1000 * time_us && event.x_px == x_px && event.y_px == y_px &&
         event.brighter == brighter;
}

}  // namespace

class TestEvt3Decoder : public QObject {
  Q_OBJECT

 private slots:
  void words_becomeEvents();
  void state_livesOnBetweenBlocks();
  void wordsBeforeTimeAndPlace_areCounted();
  void lostWords_takeThePosition();
  void time_wrapsAndGoesOn();
  void lateTimes_areNoWraps();
  void outsideTheSensor_isCountedAndDropped();
};

void TestEvt3Decoder::words_becomeEvents() {
  Evt3Decoder decoder({640, 480});
  std::vector<Event> events;
  decoder.decode(words({kHigh | 3, kLow | 5, kY | 0x800 | 7, kEvent | 9, kEvent | kOn | 10, kBase | kOn | 100,
                        kVector12 | 0x801, kVector8 | 0x82, kTrigger | 1, 0xE123, 0x7001, 0xF002}),
                 events);
  const std::int64_t time_us = 3 * 4096 + 5;
  QCOMPARE(events.size(), std::size_t{6});
  QVERIFY(sameForEvt3Decoder(events[0], time_us, 9, 7, false));
  QVERIFY(sameForEvt3Decoder(events[1], time_us, 10, 7, true));
  QVERIFY(sameForEvt3Decoder(events[2], time_us, 100, 7, true));
  QVERIFY(sameForEvt3Decoder(events[3], time_us, 111, 7, true));
  QVERIFY(sameForEvt3Decoder(events[4], time_us, 113, 7, true));
  QVERIFY(sameForEvt3Decoder(events[5], time_us, 119, 7, true));
  QCOMPARE(decoder.counts().triggers, std::uint64_t{1});
}

void TestEvt3Decoder::state_livesOnBetweenBlocks() {
  const std::string all = words(
      {kHigh | 1, kLow | 2, kY | 3, kBase | 4, kVector12 | 0xFFF, kVector8 | 0xFF, kLow | 9, kVector12 | 1});
  Evt3Decoder whole_decoder, decoder;
  std::vector<Event> whole, events;
  whole_decoder.decode(all, whole);
  for (std::size_t i = 0; i < all.size(); i += 2) decoder.decode(all.substr(i, 2), events);
  QCOMPARE(whole.size(), std::size_t{21});
  QVERIFY(std::equal(whole.begin(), whole.end(), events.begin(), events.end(),
                     [](const Event& a, const Event& b) {
                       return sameForEvt3Decoder(a, b.time_ns / 1000, b.x_px, b.y_px, b.brighter);
                     }));
}

void TestEvt3Decoder::wordsBeforeTimeAndPlace_areCounted() {
  Evt3Decoder decoder;
  std::vector<Event> events;
  decoder.decode(words({kEvent | 1, kLow | 5, kEvent | 1, kHigh | 1, kY | 1, kEvent | 1, kLow | 6, kEvent | 2,
                        kVector8 | 1, kBase | 3, kVector8 | 1}),
                 events);
  QCOMPARE(times_us(events), (std::vector<std::int64_t>{4102, 4102}));
  QCOMPARE(decoder.counts().unplaced, std::uint64_t{4});
}

void TestEvt3Decoder::lostWords_takeThePosition() {
  Evt3Decoder decoder;
  std::vector<Event> events;
  decoder.decode(words({kHigh | 1, kLow | 5, kY | 1, kBase | 1}), events);
  decoder.forgetPosition();
  decoder.decode(words({kEvent | 1, kVector8 | 1, kY | 2, kVector8 | 1, kEvent | 4}), events);
  QCOMPARE(events.size(), std::size_t{1});
  QVERIFY(sameForEvt3Decoder(events[0], 4101, 4, 2, false));
}

void TestEvt3Decoder::time_wrapsAndGoesOn() {
  Evt3Decoder decoder;
  std::vector<Event> events;
  decoder.decode(
      words({kHigh | 0xFFF, kLow | 0xFFF, kY | 1, kEvent | 1, kHigh | 0, kEvent | 1, kLow | 1, kEvent | 1,
             kHigh | 0x900, kLow | 0, kEvent | 1, kHigh | 0x100, kLow | 0, kEvent | 1}),
      events);
  constexpr std::int64_t kWrap = 1 << 24;
  QCOMPARE(times_us(events), (std::vector<std::int64_t>{kWrap - 1, kWrap, kWrap + 1, kWrap + (0x900 << 12),
                                                        2 * kWrap + (0x100 << 12)}));
}

void TestEvt3Decoder::lateTimes_areNoWraps() {
  Evt3Decoder decoder;
  std::vector<Event> events;
  decoder.decode(words({kHigh | 0xFFF, kLow | 0, kY | 1, kEvent | 1, kHigh | 1, kHigh | 0xFFE, kLow | 0,
                        kEvent | 1, kHigh | 2, kLow | 0, kEvent | 1, kHigh | 1, kLow | 0, kEvent | 1}),
                 events);
  QCOMPARE(times_us(events),
           (std::vector<std::int64_t>{0xFFF << 12, 0xFFE << 12, 0x1002 << 12, 0x1001 << 12}));
}

void TestEvt3Decoder::outsideTheSensor_isCountedAndDropped() {
  Evt3Decoder decoder({320, 240});
  std::vector<Event> events;
  decoder.decode(words({kHigh | 1, kLow | 5, kY | 239, kEvent | 319, kEvent | 320, kBase | 316,
                        kVector12 | 0x0FF, kY | 240, kEvent | 0}),
                 events);
  QCOMPARE(events.size(), std::size_t{5});
  QCOMPARE(decoder.counts().outside, std::uint64_t{6});
}

EVICAL_TEST(TestEvt3Decoder)
#include "tst_evt3_decoder.moc"
