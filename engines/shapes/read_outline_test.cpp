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

TEST(ReadOutline, takes_what_geographic_programs_write_where_it_has_one_meaning)
{
	const std::string ring = "(0 0, 2 0, 2 3, 0 3, 0 0)";
	EXPECT_DOUBLE_EQ(area_in("SRID=4326;POLYGON (" + ring + ")"), 6);
	EXPECT_DOUBLE_EQ(area_in("srid = 25832 ; Polygon(" + ring + ");"), 6);
	EXPECT_DOUBLE_EQ(area_in("MULTIPOLYGON ((" + ring + "))"), 6) << "of one member";
	EXPECT_DOUBLE_EQ(area_in("WKT,id,name\n\"MULTIPOLYGON ((" + ring + "))\",1,plate\n"), 6) << "quoted in a table";
	EXPECT_DOUBLE_EQ(area_in("\"POLYGON (" + ring + ")\""), 6);
	EXPECT_DOUBLE_EQ(area_in("POLYGON\r\n((0 0,\r\n2 0, 2 3,\r\n0 3))"), 6) << "over several lines";
	for (const char* tag : { "POLYGON Z", "POLYGONZ", "POLYGON M", "POLYGONM" })
		EXPECT_DOUBLE_EQ(area_in(std::string(tag) + " ((0 0 7, 2 0 7, 2 3 7, 0 3 7))"), 6) << tag;
	EXPECT_DOUBLE_EQ(area_in("POLYGON ZM ((0 0 7 1, 2 0 7 2, 2 3 7 3, 0 3 7 4))"), 6) << "equal heights, any measures";
}

TEST(ReadOutline, counts_the_numbers_of_every_vertex_in_wkt)
{
	const auto expect = [](const std::string& wkt, const std::string& said) {
		EXPECT_TRUE(mentions(refusal(wkt), said)) << wkt << ": " << refusal(wkt);
	};
	expect("POLYGON ((0 0, 10 0, 10, 0 10, 0 0))", "vertex 2 of the WKT must hold 2 numbers, got '10'");
	expect("POLYGON ((0 5, 6, 6.5 9, 3 12, 0 5))", "vertex 1 of the WKT must hold 2 numbers, got '6'");
	expect("Polygon((0 1, 1 2, 3 4 5, 0 1))", "vertex 2 of the WKT must hold 2 numbers, got '3 4 5'");
	expect("POLYGON ((0 0, 1 0, , 1 1))", "vertex 2 of the WKT must hold 2 numbers, got ''");
	expect("POLYGON ((0 0, 1 zero, 1 1))", "vertex 1 of the WKT must hold 2 numbers, got '1 zero'");
	expect("POLYGON ((0 0, 1,5 0, 1 1))", "decimals with a point");
	expect("POLYGON Z ((0 0 1, 1 0, 1 1 1))", "vertex 1 of the WKT must hold 3 numbers, got '1 0'");
	expect("POLYGON M ((0 0, 1 0, 1 1))", "vertex 0 of the WKT must hold 3 numbers");
	expect("POLYGON Z ((0 0 1, 1 0 2, 1 1 1))", "at one height");
}

TEST(ReadOutline, refuses_other_geometries_and_holes)
{
	const auto expect = [](const std::string& text, const std::string& said) {
		EXPECT_TRUE(mentions(refusal(text), said)) << text << ": " << refusal(text);
	};
	expect("MULTIPOLYGON (((0 0, 1 0, 1 1)),((2 2, 3 2, 3 3)))", "must be one POLYGON, got 2");
	expect("LINESTRING (0 0, 1 1)", "got a LINESTRING");
	expect("CURVEPOLYGON (CIRCULARSTRING (0 0, 1 1, 2 0, 1 -1, 0 0))", "got a CURVEPOLYGON");
	expect("POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0),(1 1, 2 1, 2 2, 1 1))", "must not have holes, got 1");
	expect("POLYGON ((0 0, 1 0, 1 1))\nPOLYGON ((0 0, 1 0, 1 1))", "after the polygon stands 'POLYGON");
	expect("POLYGON ((0 0, 1 0, 1 1)", "cannot read the WKT: ')' must stand before ''");
	expect("POLYGON (0 0, 1 0, 1 1)", "cannot read the WKT: '(' must stand before '0 0, 1 0");
	expect("POLYGON EMPTY", "is EMPTY");
	expect("SRID=1;MULTIPOLYGON Z EMPTY", "is EMPTY");
	expect("id;WKT\n1;\"POLYGON ((0 0, 1 0, 1 1))\"\n2;\"POLYGON ((0 0, 1 0, 1 1))\"\n", "must hold one outline, got 2");
}

TEST(ReadOutline, names_the_faulty_line)
{
	const auto expect = [](const std::string& text, const std::string& said) {
		EXPECT_TRUE(mentions(refusal(text), said)) << text << ": " << refusal(text);
	};
	expect("0,0\n1,0\n1;one\n", "line 3 must hold two numbers x, y, got '1;one'");
	expect("0,0\n1,0,0\n1,1\n", "line 2");
	expect("0,0\n1,,0\n1,1\n", "line 2");
	expect("0,0\n1, ,0\n1,1\n", "line 2");
	expect("0,0\n,1,0\n1,1\n", "line 2");
	expect("0,0\r1\r1,1\r", "line 2");
	expect("x,y\nx,y\n0,0\n", "line 2");  // only one header
	expect("0,0\n0,1.5,5\n", "decimals take a point");
	expect("0,0\n1,nan\n1,1\n", "vertex 1 (1, nan)");
	expect("", "got 0");
}

TEST(ReadOutline, refuses_decimal_commas_from_the_first_line_on)
{
	for (const char* text : { "0,0;0,0\n6,0;0,0\n3,0;8,5\n", "0,5 1,5\n", "0,5\t1,5\n", "\"0,5\";\"1,5\"\n" })
		EXPECT_TRUE(mentions(refusal(text), "line 1 must hold two numbers") && mentions(refusal(text), "decimals take a point"))
			<< text << refusal(text);
	EXPECT_DOUBLE_EQ(area_in("\"0\",\"0\"\n\"2\",\"0\"\n\"2\",\"3\"\n\"0\",\"3\""), 6) << "quoted numbers";
}

TEST(ReadOutline, says_what_the_text_is_if_it_is_no_text)
{
	EXPECT_TRUE(mentions(refusal(std::string("\xFF\xFE"
											 "0\0,\0",
							 6)),
		"got UTF-16"));
	EXPECT_TRUE(mentions(refusal(std::string("0\0,\0000\0\n\0", 8)), "got UTF-16")) << "without a mark";
	EXPECT_TRUE(mentions(refusal(std::string("\x7f"
											 "ELF\1\2\0\0",
							 8)),
		"got binary data"));
}

TEST(ReadOutline, names_the_file)
{
	const std::string path = testing::TempDir() + "graindrive_outline.csv";
	std::ofstream(path) << "0,0\n1,0\n";
	EXPECT_TRUE(mentions(complaint([&] { read_outline(path); }), path + ": outline needs at least 3"));
	std::ofstream(path) << "0,0\n1,0\n0,1\n";
	EXPECT_DOUBLE_EQ(solid_of(read_outline(path)).area, 0.5);
	std::remove(path.c_str());
	EXPECT_TRUE(mentions(complaint([&] { read_outline(path); }), "cannot read an outline from '" + path.substr(0, 20)));
	EXPECT_TRUE(mentions(complaint([&] { read_outline(testing::TempDir()); }), "got a folder"));
	EXPECT_TRUE(mentions(complaint([&] { read_outline("/dev/zero"); }), "got a pipe or a device"));
	EXPECT_TRUE(mentions(complaint([&] { read_outline(std::string("a\0.csv", 6)); }), "byte 0"));
}
