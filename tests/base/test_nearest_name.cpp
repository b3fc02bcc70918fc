#include "graspfit/base/nearest_name.hpp"
#include "support/catch.hpp"

namespace test_nearest_name {

using graspfit::base::did_you_mean;
using graspfit::base::nearest_name;

TEST_CASE("A mistyped name is told from its nearest known one", "[base][nearest_name]") {
  const std::vector<std::string> known = {"plan", "inspect", "evaluate", "hold", "hand", "shape"};
  // In these one letter is replaced, left out or inserted, two neighbors are swapped, or the case
  // is another.
  for (const char* name : {"plam", "pla", "plaan", "paln", "PLAN"}) {
    INFO(name);
    CHECK(nearest_name(name, known) == "plan");
  }
  CHECK(nearest_name("inpsect", known) == "inspect");
  CHECK(nearest_name("evalaute", known) == "evaluate");
  CHECK(nearest_name("evauate", known) == "evaluate");
  CHECK(did_you_mean("plam", known) == "; did you mean \"plan\"?");
}

TEST_CASE("A third of the letters is near, more is not", "[base][nearest_name]") {
  CHECK(nearest_name("abcxyf", {"abcdef"}) == "abcdef");  // 2 of 6 letters differ.
  CHECK_FALSE(nearest_name("abxyzf", {"abcdef"}));        // 3 of 6 letters differ.
  CHECK(nearest_name("ab", {"ac"}) == "ac");              // One letter may always differ.
  CHECK_FALSE(nearest_name("a", {"b"}));                  // Here that would leave none.
  CHECK_FALSE(nearest_name("", {"a"}));
  CHECK_FALSE(nearest_name("whatever", {}));
  CHECK(did_you_mean("whatever", {"plan"}).empty());
}

TEST_CASE("Of names equally near the first is meant, and a nearer one before it",
          "[base][nearest_name]") {
  CHECK(nearest_name("w4", {"w1", "w2", "w3"}) == "w1");
  CHECK(nearest_name("table2", {"table1", "tables", "table1_refined"}) == "table1");
  CHECK(nearest_name("tabel_2", {"tab_e_3", "table_2"}) == "table_2");
}

TEST_CASE("The beginning of a longer name is completed where nothing is near",
          "[base][nearest_name]") {
  CHECK(nearest_name("dexonomy", {"dexgraspbench-100g", "dexonomy-hard"}) == "dexonomy-hard");
  CHECK_FALSE(nearest_name("de", {"dexonomy-hard"}));
}

}  // namespace test_nearest_name
