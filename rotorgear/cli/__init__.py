"""The command line: one small file a command. Arguments, tables and progress bars; no numerics."""
