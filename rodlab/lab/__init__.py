"""What a person touches: the only wing that prints, draws and writes."""
