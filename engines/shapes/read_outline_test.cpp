/// Files with outlines: both formats in their usual forms, and messages that name the faulty line.
#include "engines/shapes/read_outline.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "engines/base/temporary_file.hpp"
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

TEST(ReadOutline, takes_a_header_that_names_x_and_y)
{
	const std::string square = "\n0,0\n2,0\n2,3\n0,3\n";
	for (const char* header : { "x,y", "X;Y", "x\ty", "x y", "\"x\",\"y\"", "x [d], y [d]", "X (d);Y (d)", "x [d] y [d]",
			 "x[d] y[d]", "\"x [d]\",\"y [d]\"", "x,y,", " x , y # corners" })
		EXPECT_DOUBLE_EQ(area_in(header + square), 6) << header;
}

TEST(ReadOutline, refuses_a_header_with_another_unit_than_grain_diameters)
{
	for (const char* header :
		{ "x [mm],y [mm]", "X (m);Y (m)", "x [d], y [mm]", "x [m] y [m]", "\"x [cm]\",\"y [cm]\"", "x [], y []" }) {
		const std::string said = refusal(std::string("\n") + header + "\n0,0\n2,0\n2,3\n");
		EXPECT_TRUE(mentions(said, "line 2 gives lengths in '")) << header << ": " << said;
		EXPECT_TRUE(mentions(said, "divide them by d and write [d] or no unit")) << header << ": " << said;
	}
}

TEST(ReadOutline, does_not_take_a_mistyped_vertex_for_a_header)
{
	const std::string three = "\n4,-4\n4,4\n-4,4\n";
	for (const char* first : { "l,O", "\u22124,\u22124", "\uFF10,\uFF10", "\u0660,\u0660", "'0','0'", "$0,$0", "y,x", "x,y,z",
			 "id,x,y", "x", "x 4,y 4", "x=0,y=0", "west,south", "O O", "\"0,\"0", "4\",4\"" }) {
		const std::string said = refusal(first + three);
		EXPECT_TRUE(mentions(said, "line 1 must hold two numbers x, y, got '")) << first << ": " << said;
		EXPECT_TRUE(mentions(said, "a header names x and y alone, as in x [d], y [d]")) << first << ": " << said;
	}
	EXPECT_TRUE(
		mentions(refusal("\u22124,\u22124" + three), "(with U+2212; numbers are written with 0 to 9, +, -, . and e alone)"));
	EXPECT_FALSE(mentions(refusal("0,0\nl,O\n"), "a header names")) << "only the first line can be one";
}

TEST(ReadOutline, names_the_character_that_only_looks_like_a_digit)
{
	EXPECT_TRUE(mentions(refusal("0,0\n\uFF14,0\n"), "line 2 must hold two numbers x, y, got '???,0' (with U+FF14"));
	EXPECT_TRUE(mentions(
		refusal("POLYGON ((0 0, 4 \u22124, 4 4))"), "vertex 1 of the WKT must hold 2 numbers, got '4 ???4' (with U+2212"));
}

TEST(ReadOutline, refuses_a_second_srid)
{
	for (const char* text : { "SRID=1;SRID=2;POLYGON ((0 0, 1 0, 1 1))", "srid = 1; SRID = 1; POLYGON EMPTY" })
		EXPECT_TRUE(mentions(refusal(text), "must have at most one SRID=...; before it")) << text << ": " << refusal(text);
}

TEST(ReadOutline, counts_before_it_reads)
{
	const auto repeated = [](std::size_t times, const std::string& text) {
		std::string all;
		for (std::size_t i = 0; i < times; ++i) all += text;
		return all;
	};
	const auto expect = [](const std::string& text, const std::string& said) {
		EXPECT_TRUE(mentions(refusal(text), said)) << refusal(text);
	};
	expect("POLYGON((" + repeated(2000000, ",") + "))", "at most 200000 vertices in all, got 2000001");
	expect("POLYGON((0 0)" + repeated(100000, ",(0 0, 1 0, 1 1)") + ")", "at most 1000 opening brackets in its WKT, got 100002");
	expect("POLYGON((0 0, " + repeated(1000000, "0 ") + "))", "vertex 1 of the WKT must hold 2 numbers");
	expect(repeated(3000000, "\""), "line 1 must hold two numbers");
	expect(repeated(3000000, ","), "line 1 must hold two numbers");
	expect(repeated(2000000, "\"\n"), "at most 400000 lines, got 2000001");
	expect(repeated(4000000, "\n") + "0,0\n1,0\n0,1\n", "at most 400000 lines, got 4000004; leave out blank lines");
	expect(repeated(1000000, "\r\n") + "0,0\r\n1,0\r\n0,1\r\n", "at most 400000 lines, got 1000004");
	expect(repeated(300000, "0 0\n"), "at most 200001 lines that are not blank, got 300000");
	EXPECT_DOUBLE_EQ(area_in(repeated(300000, "\n") + "0,0\n1,0\n0,1\n"), 0.5) << "blank lines that are not too many";
}

TEST(ReadOutline, says_what_the_text_is_if_it_is_no_text)
{
	const std::string corners = "0,0\n4,0\n";
	const auto wide = [&](std::size_t width, std::size_t place) {
		std::string text(width * corners.size(), '\0');
		for (std::size_t i = 0; i < corners.size(); ++i) text[width * i + place] = corners[i];
		return text;
	};
	const auto expect = [](const std::string& text, const std::string& said) {
		EXPECT_TRUE(mentions(refusal(text), said)) << said << ": " << refusal(text);
	};
	expect(wide(2, 0), "got UTF-16; save it as UTF-8");
	expect(wide(2, 1), "got UTF-16");
	expect("\xFF\xFE" + wide(2, 0), "got UTF-16");
	expect(wide(4, 0), "got UTF-32; save it as UTF-8");
	expect(wide(4, 3), "got UTF-32");
	expect(std::string("\xFF\xFE\0\0", 4) + wide(4, 0), "got UTF-32");
	expect(std::string("\0\0\xFE\xFF", 4) + wide(4, 3), "got UTF-32");
	for (const char* line_end : { "\x15", "\x25", "\r\x25" })  // EBCDIC's own digits, comma and line ends
		expect(std::string("\xF0\x6B\xF0") + line_end + "\xF4\x6B\xF0" + line_end, "got EBCDIC; save it as UTF-8");
	expect("\U0001D7D8,\U0001D7D8\n", "(with U+1D7D8");  // digits beyond ASCII begin with F0 in UTF-8
	expect(std::string("\x7f"
					   "ELF\1\2\0\0",
			   8),
		"got binary data");
}

TEST(ReadOutline, names_the_file)
{
	const graindrive::test::TemporaryFile file;
	const std::string& path = file.path();
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
