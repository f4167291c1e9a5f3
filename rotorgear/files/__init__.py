"""Files, folders and texts of others: every reader, every writer and every cache of the package goes through here."""
