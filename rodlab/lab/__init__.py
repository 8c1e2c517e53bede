"""What a person sees: tables, pictures and files. The only wing that draws and writes; `cli` prints."""
