#!/usr/bin/env python3
"""Condenses IERS finals2000A to the table that umov compiles in.

usage: make_earth_tables.py finals2000A.all > data/earth/eop.csv
"""
import sys

print("# Earth orientation, IERS finals2000A (Bulletin A columns): polar motion x, y [arcsec] and")
print("# UT1-UTC [s] at 0h UTC of each day; 1 where UT1-UTC is predicted. Made by")
print("# tools/make_earth_tables.py; see README.md.")
print("mjd,x_arcsec,y_arcsec,ut1_utc_s,is_predicted")
for line in open(sys.argv[1], encoding="ascii"):
    # Columns of finals.all (IERS readme.finals2000A): MJD 8-15, x 19-27, y 38-46, flag of UT1 58,
    # UT1-UTC 59-68.
    mjd, x, y, dut1 = line[7:15], line[18:27], line[37:46], line[58:68]
    if dut1.strip():
        print(f"{float(mjd):.0f},{float(x)},{float(y)},{float(dut1)},{int(line[57] == 'P')}")
