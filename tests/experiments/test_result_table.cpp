#include <limits>
#include <stdexcept>

#include "graspfit/sweep/result_table.hpp"
#include "support/catch.hpp"

namespace test_result_table {

using namespace graspfit::sweep;

TEST_CASE("CSV fields read back as what they are", "[experiments][result_table]") {
  CHECK(csv_field({}).empty());
  CHECK(csv_field(true) == "true");
  CHECK(csv_field(std::int64_t{-3}) == "-3");
  CHECK(csv_field(0.1) == "0.1");
  CHECK(std::stod(csv_field(1.0 / 3.0)) == 1.0 / 3.0);
  CHECK(csv_field(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(csv_field(std::numeric_limits<double>::infinity()).empty());
  CHECK(csv_field(std::string("plain")) == "plain");
  // By RFC 4180 commas and quotes are quoted and quotes doubled; a row stays one line.
  CHECK(csv_field(std::string("a,b")) == "\"a,b\"");
  CHECK(csv_field(std::string("say \"x\"")) == "\"say \"\"x\"\"\"");
  CHECK(csv_field(std::string("two\nlines")) == "two lines");
  CHECK(csv_line({"a", "", "b"}) == "a,,b\n");
}

TEST_CASE("A field is a number as a whole or not at all", "[experiments][result_table]") {
  CHECK(csv_number("-2.5e-3") == -2.5e-3);
  CHECK(csv_number("7") == 7.0);
  for (const char* const field : {"", "7 m", "m", "7,", "\"7\""}) CHECK_FALSE(csv_number(field));
}

TEST_CASE("A row knows its columns", "[experiments][result_table]") {
  ResultRow row({{"a", "", ""}, {"b_m", "m", ""}});
  row.set("b_m", 0.5);
  CHECK(row.csv_fields() == std::vector<std::string>{"", "0.5"});
  CHECK_THROWS_AS(row.set("c", 1.0), std::logic_error);
}

}  // namespace test_result_table
