// Texts that differ in numbers alone become one with the range.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/alike.h"

namespace lodbench::results {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(FoldAlike, texts_that_differ_in_numbers_give_their_range_as_they_were_written) {
    EXPECT_THAT(
        fold_alike({"load 9.50 on 2 cores", "load 10.25 on 2 cores", "load 2.00 on 2 cores"}),
        ElementsAre("load 2.00 to 10.25 on 2 cores"));
    EXPECT_THAT(fold_alike({"1 of 4", "3 of 8."}), ElementsAre("1 of 4", "3 of 8."))
        << "other words";
    EXPECT_THAT(fold_alike({"b 1", "a 1", "b 2"}), ElementsAre("b 1 to 2", "a 1"));
}

TEST(FoldAlike, keeps_what_stands_alone_or_has_no_number) {
    EXPECT_THAT(fold_alike({}), IsEmpty());
    EXPECT_THAT(fold_alike({"", "", "none", "none", "5", "v1.2.3", "1.50", "1.5"}),
                ElementsAre("", "none", "1.50 to 5", "v1.2.3"));
}

}  // namespace
}  // namespace lodbench::results
