"""Prints the ten slowest tests of a JUnit report."""

import sys
import xml.etree.ElementTree as xml

cases = [(float(case.get("time", 0)), case.get("name")) for case in xml.parse(sys.argv[1]).iter("testcase")]
print("the ten slowest tests:")
for seconds, name in sorted(cases, reverse=True)[:10]:
    print(f"{seconds:7.1f} s  {name}")
