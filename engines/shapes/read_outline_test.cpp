/// Files with outlines: both formats in their usual spellings, and messages that lead to the faulty line.
#include "engines/shapes/read_outline.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "engines/shapes/solid.hpp"
#include "engines/shapes/test_support.hpp"

using namespace graindrive;
using namespace graindrive::shapes;

namespace {

Real area_in(const std::string& text) { return solid_of(Outline(vertices_in(text))).area; }

std::string refusal(const std::string& text)
{
	return complaint([&] { Outline outline(vertices_in(text)); });
}

}  // namespace

TEST(ReadOutline, takes_wkt)
{
	EXPECT_DOUBLE_EQ(area_in("POLYGON ((0 0, 2 0, 2 3, 0 3, 0 0))"), 6);
	EXPECT_DOUBLE_EQ(area_in("# a plate\n  polygon((0 0,0 3,2 3,2 0,0 0))\n\n"), 6);
	EXPECT_DOUBLE_EQ(area_in("POLYGON((0 0, 2e0 0, 2 3, 0 3))"), 6) << "unclosed ring";
}

TEST(ReadOutline, takes_csv)
{
	EXPECT_DOUBLE_EQ(area_in("0,0\n2,0\n2,3\n0,3\n"), 6);
	EXPECT_DOUBLE_EQ(area_in("\xEF\xBB\xBFx,y\r\n0,0\r\n2,0\r\n2,3\r\n0,3\r\n"), 6) << "header, DOS line ends, byte-order mark";
	EXPECT_DOUBLE_EQ(area_in("# plate\nx [d]; y [d]\n0; 0 # corner\n\n+2;0\n2;3\n0;3"), 6)
		<< "semicolons, comments, no last line end";
	EXPECT_DOUBLE_EQ(area_in("0 0\n2\t0\n2 3\n0 3"), 6) << "blanks";
}

TEST(ReadOutline, refuses_other_geometries_and_holes)
{
	EXPECT_TRUE(mentions(refusal("MULTIPOLYGON (((0 0, 1 0, 1 1)),((2 2, 3 2, 3 3)))"), "got a MULTIPOLYGON"));
	EXPECT_TRUE(mentions(refusal("LINESTRING (0 0, 1 1)"), "got a LINESTRING"));
	EXPECT_TRUE(mentions(refusal("POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0),(1 1, 2 1, 2 2, 1 1))"), "must not have holes, got 1"));
	EXPECT_TRUE(mentions(refusal("POLYGON ((0 0, 1 0, 1 1))\nPOLYGON ((0 0, 1 0, 1 1))"), "cannot read the WKT"));
	EXPECT_TRUE(mentions(refusal("POLYGON ((0 0, 1 zero, 1 1))"), "cannot read the WKT"));
	EXPECT_TRUE(mentions(refusal("POLYGON EMPTY"), "at least 3 different vertices, got 0"));
}

TEST(ReadOutline, names_the_faulty_line)
{
	EXPECT_TRUE(mentions(refusal("0,0\n1,0\n1;one\n"), "line 3 must hold two numbers x, y, got '1;one'"));
	EXPECT_TRUE(mentions(refusal("0,0\n1,0,0\n1,1\n"), "line 2"));
	EXPECT_TRUE(mentions(refusal("0,0\n1,,0\n1,1\n"), "line 2"));
	EXPECT_TRUE(mentions(refusal("x,y\nx,y\n0,0\n"), "line 2")) << "only one header";
	EXPECT_TRUE(mentions(refusal("0,0\n0,1.5,5\n"), "decimals take a point"));
	EXPECT_TRUE(mentions(refusal("0,0\n1,nan\n1,1\n"), "vertex 1 (1, nan)"));
	EXPECT_TRUE(mentions(refusal(""), "got 0"));
}

TEST(ReadOutline, names_the_file)
{
	const std::string path = testing::TempDir() + "graindrive_outline.csv";
	std::ofstream(path) << "0,0\n1,0\n";
	EXPECT_TRUE(mentions(complaint([&] { read_outline(path); }), path + ": outline needs at least 3"));
	std::ofstream(path) << "0,0\n1,0\n0,1\n";
	EXPECT_DOUBLE_EQ(solid_of(read_outline(path)).area, 0.5);
	std::remove(path.c_str());
	EXPECT_TRUE(mentions(complaint([&] { read_outline(path); }), "cannot read an outline from '" + path));
	EXPECT_TRUE(mentions(complaint([&] { read_outline(testing::TempDir()); }), "readable file")) << "a folder";
}
