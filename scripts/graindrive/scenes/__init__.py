"""Scenes in YADE: materials, disks in a plane, spheres in a box."""
