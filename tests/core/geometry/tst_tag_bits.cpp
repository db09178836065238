// The tags' bits against the pictures that the family's own library draws.
#include "core/geometry/marker_bits.h"
#include "tests/support/test_program.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <cstdlib>
#include <memory>

namespace {

using namespace evical;

void destroy(image_u8_t* image) {
  std::free(image->buf);
  std::free(image);
}

class TestTagBits : public QObject {
  Q_OBJECT

 private slots:
  void bits_areThoseOfTheFamilysPictures() {
    const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                  tag36h11_destroy);
    const std::vector<PatternBits> tags = firstTags(static_cast<int>(family->ncodes));
    QCOMPARE(tags.size(), std::size_t{587});
    const int inner = (family->total_width - kTagSide_bits) / 2;
    for (const std::size_t id : {0, 1, 35, 586}) {
      const std::unique_ptr<image_u8_t, void (*)(image_u8_t*)> picture(
          apriltag_to_image(family.get(), static_cast<std::uint32_t>(id)), destroy);
      for (int row = 0; row < kTagSide_bits; ++row)
        for (int col = 0; col < kTagSide_bits; ++col)
          QCOMPARE(tags[id][static_cast<std::size_t>(row)][static_cast<std::size_t>(col)],
                   picture->buf[(inner + row) * picture->stride + inner + col] != 0);
    }
  }

  void askedForMore_thereAreNoMore() {
    QCOMPARE(firstTags(600).size(), std::size_t{587});
    QCOMPARE(firstTags(2).size(), std::size_t{2});
    QVERIFY(firstTags(-1).empty());
  }
};

}  // namespace

EVICAL_TEST(TestTagBits)
#include "tst_tag_bits.moc"
