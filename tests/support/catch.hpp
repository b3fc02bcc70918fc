#pragma once

// The one place that names Catch2's header, so that its version can change here.
#include <catch2/catch.hpp>
