// Walks two tables side by side.
#pragma once

#include <hompm/verify/field_judge.hpp>
#include <hompm/verify/table.hpp>

namespace hompm::detail {

/// Hands every pair of values with the same time and particle to `judge`; rows without a counterpart or in
/// another order become messages. `fields` counts the fields of the tables. Throws `FileError`.
void compare_tables(Table& a, Table& b, std::size_t fields, FieldJudge& judge);

}  // namespace hompm::detail
